#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Muscle.h"
#include "bake/motion/PoseBlend.h"

#include <span>
#include <vector>

namespace tss {

/// The share of the insertion's bone in the motion of each vertex of a muscle between two bones, #V in [0,
/// 1]: Muscle::insertionShares (METHOD 6.1). It is a share of the place, not of the material: with a / (a +
/// b), a and b the fourth powers of the distances from the origin's and the insertion's bone, it changes near
/// the joint alone, so that a muscle that runs along a bone stays beside it. Where the insertion's bone would
/// turn triangles over, it is made to change more slowly. A ring has shares as skin has (6.3). Empty where a
/// bone has no mesh: the muscle's fibre then decides. surface, origin, insertion: meshes at rest, all in one
/// frame, scene units. far: motions of the insertion's bone since rest, seen from the origin's bone; the sign
/// of each quaternion says which way round it turned.
std::vector<double> insertionShares(const TriangleMesh& surface, const TriangleMesh& origin,
                                    const TriangleMesh& insertion, MuscleForm form,
                                    std::span<const DualPose> far = {});

} // namespace tss
