#pragma once
#include "bake/model/SceneModel.h"
#include "bake/motion/BoneChain.h"

#include <span>

namespace tss {

/// Where joints take the bones of a muscle, seen from its origin's bone in the surface's frame.
struct MuscleWays {
    /// #samples of #bones behind the first: motions since rest; the sign of each tells which way round it
    /// turned.
    std::vector<std::vector<DualPose>> motions;
    std::vector<Eigen::Vector4d> sides; ///< Muscle::sides
    /// The joints reach the same orientation turning either way, or nearly a whole turn: Muscle::sides cannot
    /// tell which way round the muscle is turned there.
    bool unclear = false;
};

/// The motions of a muscle's bones since rest, in the surface's frame. chain: its muscleChain(). placements:
/// body to world now, one per body.
ChainMotion muscleMotion(const SceneModel& scene, const MuscleModel& muscle, std::span<const int> chain,
                         std::span<const Pose> placements);

/// Over the limits of the joints between the first and the last bone: of one value at a time, and of one
/// value of each joint together, since a muscle over two joints is bent by both. Values without limits stay
/// at rest.
MuscleWays muscleWays(const SceneModel& scene, const MuscleModel& muscle);

} // namespace tss
