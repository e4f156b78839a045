#pragma once
#include "bake/motion/Motion.h"

#include <vector>

namespace tss {

/// The motion of all bodies under a skin while one joint value goes from rest to a limit, sampled: #samples
/// of #bodies poses, each the motion since rest of the bone that the body moves with, in the skin's frame.
using BoneSwing = std::vector<std::vector<Pose>>;

/// Motion of the insertion's bone since rest, seen from the origin's; exactly the identity while both move
/// alike.
inline Pose between(const Pose& origin, const Pose& insertion) {
    return origin.matrix() == insertion.matrix() ? Pose::Identity()
                                                 : origin.inverse(Eigen::Isometry) * insertion;
}

} // namespace tss
