#pragma once
#include "bake/geometry/MeshQuery.h"
#include "bake/motion/MotionBound.h"

namespace tss {

/// Whether any two triangles of A and B stay farther apart than `distance` all over the cell. Two are told
/// apart along one direction: B's corners move along it by no more than the slope there says and what second
/// order adds, so that surfaces which slide past each other may be as near as they like. false: not shown.
/// rounding: see coordinateRounding(). looked: counts pairs of nodes and triangles; beyond `most` it gives
/// up.
bool trianglesApart(const MeshQuery& a, const MeshQuery& b, const CellMotion& motion, double distance,
                    double rounding, std::uint64_t most, std::uint64_t& looked);

} // namespace tss
