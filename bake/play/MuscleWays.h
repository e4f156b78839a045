#pragma once
#include "bake/model/SceneModel.h"
#include "bake/motion/PoseBlend.h"

#include <span>

namespace tss {

/// Where joints take the insertion's bone of a muscle, seen from its origin's bone in the surface's frame.
struct MuscleWays {
    std::vector<DualPose> far;        ///< since rest; each on the way round that its joints take
    Eigen::Vector4d side{0, 0, 0, 1}; ///< Muscle::side
    /// Places that look alike are come to by both ways round, or a whole turn is near: Muscle::side cannot
    /// tell how the muscle lies there.
    bool unclear = false;
};

/// The motion of the insertion's bone since rest, seen from the origin's, in the surface's frame. placements:
/// body to world now, one per body.
Pose insertionMotion(const SceneModel& scene, const MuscleModel& muscle, std::span<const Pose> placements);

/// Over the limits of the joints between the two bones: of one value at a time, and of one value of each
/// joint together, since a muscle over two joints is bent by both. Values without limits stay at rest.
MuscleWays muscleWays(const SceneModel& scene, const MuscleModel& muscle);

} // namespace tss
