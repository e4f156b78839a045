#pragma once
#include "bake/model/SceneModel.h"
#include "bake/motion/PoseBlend.h"

#include <span>

namespace tss {

/// Where joints take the insertion's bone of a muscle, seen from its origin's bone in the surface's frame.
struct MuscleWays {
    std::vector<DualPose> far; ///< motions since rest; the sign of each tells which way round it turned
    Eigen::Vector4d side{0, 0, 0, 1}; ///< Muscle::side
    /// The joints reach the same orientation turning either way, or nearly a whole turn: Muscle::side cannot
    /// tell which way round the muscle is turned there.
    bool unclear = false;
};

/// The motion of the insertion's bone since rest, seen from the origin's, in the surface's frame. placements:
/// body to world now, one per body.
Pose insertionMotion(const SceneModel& scene, const MuscleModel& muscle, std::span<const Pose> placements);

/// Over the limits of the joints between the two bones: of one value at a time, and of one value of each
/// joint together, since a muscle over two joints is bent by both. Values without limits stay at rest.
MuscleWays muscleWays(const SceneModel& scene, const MuscleModel& muscle);

} // namespace tss
