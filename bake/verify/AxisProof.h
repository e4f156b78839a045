#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"

namespace tss::verify {

/// Whether some plane whose normal is the axis of a turn keeps the two bodies more than `clearance` (scene
/// units) apart at every pose of the limits: what moves B along that normal is bounded DOF by DOF, in
/// extended precision. false: not shown.
bool apartAcrossAxis(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion, double clearance);

} // namespace tss::verify
