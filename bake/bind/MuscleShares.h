#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Muscle.h"
#include "bake/motion/PoseBlend.h"

#include <span>
#include <vector>

namespace tss {

/// Where along its bones each vertex of a muscle goes, #V in [0, 1]: Muscle::chainShares (METHOD 6.1). It
/// depends on the place, not on the material: the mean of the bones' own shares, 0, 1 / n, ... 1, by inverse
/// fourth powers of the distances from them. So it changes near the joints alone, and a muscle that runs
/// along a bone stays beside it. Where a motion would turn triangles over, it is made to change more slowly.
/// A ring has shares as skin has (6.3). Empty where a bone has no mesh: the muscle's fibre then decides.
/// surface, bones: meshes at rest, all in one frame, scene units; bones in the order of the chain. motions:
/// each of the bones behind the first since rest, seen from the first; the sign of a quaternion says which
/// way round that turned.
std::vector<double> chainShares(const TriangleMesh& surface, std::span<const TriangleMesh> bones,
                                MuscleForm form, std::span<const std::vector<DualPose>> motions = {});

} // namespace tss
