#include "bake/motion/BoneChain.h"

#include <algorithm>
#include <cmath>

namespace tss {

bool isAtRest(std::span<const Pose> motion) {
    return std::ranges::all_of(motion, isIdentity);
}

ChainMotion chainMotion(std::span<const Pose> poses, std::size_t first, std::span<const int> chain) {
    ChainMotion motion;
    const Pose& from = poses[first];
    for (const int k : chain)
        motion.push_back(from.matrix() == poses[k].matrix() ? Pose::Identity()
                                                            : Pose(from.inverse(Eigen::Isometry) * poses[k]));
    return motion;
}

ChainBlend::ChainBlend(const ChainMotion& motion, std::span<const Eigen::Vector4d> sides)
    : bones_{Pose::Identity()} {
    for (std::size_t k = 0; k < motion.size(); ++k) {
        const Pose step = k == 0 ? motion[0] : Pose(motion[k - 1].inverse(Eigen::Isometry) * motion[k]);
        steps_.push_back(
            DualPose(step).inHemisphereOf(k < sides.size() ? sides[k] : Eigen::Vector4d(0, 0, 0, 1)));
        bones_.push_back(motion[k]);
    }
}

Pose ChainBlend::at(double share) const {
    if (steps_.empty()) return bones_[0];
    const auto n = static_cast<double>(steps_.size());
    const double before = std::clamp(std::floor(share * n), 0.0, n - 1), t = share * n - before;
    const auto k = static_cast<std::size_t>(before);
    if (t == 0 || t == 1) return bones_[k + static_cast<std::size_t>(t)];
    PoseBlend blend(true);
    blend.add(t, steps_[k]);
    return k == 0 ? blend.pose() : bones_[k] * blend.pose();
}

} // namespace tss
