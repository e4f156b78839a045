#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/PoseBlend.h"

#include <span>
#include <vector>

namespace tss {

/// Muscle::insertionShares of a muscle between two bones, all in one frame, at rest: what lies on a bone
/// moves with it, as skin does (METHOD 6.1, 6.3), and between the two the shares change so slowly that no
/// triangle is turned over where the insertion's bone may come to. Empty, for the fibre to tell, where a bone
/// has no mesh. far: its motions since rest, seen from the origin's bone, on the way round that their
/// quaternions say.
std::vector<double> insertionShares(const TriangleMesh& surface, const TriangleMesh& origin,
                                    const TriangleMesh& insertion, std::span<const DualPose> far = {});

} // namespace tss
