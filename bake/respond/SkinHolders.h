#pragma once
#include "bake/respond/SkinCarry.h"

namespace tss {

/// What is beyond a bone lies within this of its direction from the joint: cosine of 45 degrees.
inline constexpr double aheadCosine = 0.7;

/// What carries skin with a frame, and how the frame moves.
struct FrameHolder {
    SkinHolder holder;
    std::vector<std::size_t> bodies;
    std::vector<Vec3> nearest; ///< #V: where it is nearest
    Eigen::AlignedBox3d box;
    double extent = 0;         ///< diagonal of its bounds
    std::size_t moves = 0;     ///< in how many swings
    Vec3 joint = Vec3::Zero(); ///< what its own swings leave nearest to where it is; of a slide its middle
    bool twists = false;       ///< it turns about its own length, as seen from what it hangs on
};

/// The nearest bone that moves in fewer swings than this one; null: none.
const FrameHolder* boneBefore(const std::vector<FrameHolder>& holders, std::size_t bone);

} // namespace tss
