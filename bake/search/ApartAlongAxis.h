#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"

namespace tss {

/// How far apart the two stay along the axis of one of their turns at least, at every pose of Q, scene units;
/// 0 or less: they may overlap along it. The links of a flat linkage turn about parallel axes and never leave
/// their layers, however many they are and however close the layers lie.
double apartAlongAxis(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion);

} // namespace tss
