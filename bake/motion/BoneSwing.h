#pragma once
#include "bake/motion/Motion.h"

#include <vector>

namespace tss {

/// What the bones under a skin do while one joint value goes from rest to a limit: #stations, near to each
/// other, of #muscles poses, the motion of the bone that each rides on since rest, in the skin's frame.
using BoneSwing = std::vector<std::vector<Pose>>;

/// The motion of one bone since rest as another one sees it; exactly none while the two move as one.
inline Pose between(const Pose& origin, const Pose& insertion) {
    return origin.matrix() == insertion.matrix() ? Pose::Identity()
                                                 : origin.inverse(Eigen::Isometry) * insertion;
}

} // namespace tss
