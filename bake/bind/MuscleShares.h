#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/PoseBlend.h"

#include <span>
#include <vector>

namespace tss {

/// The share of the insertion's bone in the motion of each vertex of a muscle between two bones, #V in [0,
/// 1]: Muscle::insertionShares (METHOD 6.1). What lies on a bone moves with it, as skin does (6.3); between
/// the two bones the shares change so slowly that no triangle is turned over where the insertion's bone may
/// come to. Empty where a bone has no mesh: the muscle's fibre then decides. surface, origin, insertion:
/// meshes at rest, all in one frame, scene units. far: motions of the insertion's bone since rest, seen from
/// the origin's bone; the sign of each quaternion says which way round it turned.
std::vector<double> insertionShares(const TriangleMesh& surface, const TriangleMesh& origin,
                                    const TriangleMesh& insertion, std::span<const DualPose> far = {});

} // namespace tss
