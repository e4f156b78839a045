#pragma once
#include "bake/motion/Motion.h"
#include "bake/motion/PoseBlend.h"

#include <span>
#include <vector>

namespace tss {

/// The bones that a muscle runs over, in order: that of its origin, those that it passes, that of its
/// insertion (METHOD 6.1). A share in [0, 1] is a place along them: k / n is the k-th of n + 1 bones, from 0,
/// and what lies between two of them goes with both.

/// #n: motions since rest of the bones behind the first, seen from the first; empty: one bone alone.
using ChainMotion = std::vector<Pose>;

/// Exactly nothing has moved against the first bone.
bool isAtRest(std::span<const Pose> motion);

/// poses: motions since rest of all bodies. chain: of them those behind the first. Exactly identities where
/// bones move as the first does.
ChainMotion chainMotion(std::span<const Pose> poses, std::size_t first, std::span<const int> chain);

/// The motion of any place along a chain.
class ChainBlend {
public:
    /// sides: of each bone behind the first the quaternion that tells which way round it turns against the
    /// bone before it, see DualPose::inHemisphereOf(); those that are missing: by less than half a turn.
    ChainBlend(const ChainMotion& motion, std::span<const Eigen::Vector4d> sides);

    /// Since rest, seen from the first bone; of a bone itself, as at 0 and at 1, its motion bit for bit.
    Pose at(double share) const;
    /// #n: of each bone behind the first, seen from the one before it.
    const std::vector<DualPose>& steps() const { return steps_; }

private:
    std::vector<Pose> bones_; ///< #n + 1, the first's the identity
    std::vector<DualPose> steps_;
};

/// The motion of all bodies under a skin while one joint value goes from rest to a limit, sampled: #samples
/// of #bodies poses, each the motion since rest of the bone that the body moves with, in the skin's frame.
using BoneSwing = std::vector<std::vector<Pose>>;

} // namespace tss
