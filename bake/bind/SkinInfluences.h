#pragma once
#include "bake/bind/SkinAttachment.h"

namespace tss {

/// Cosine of 45 degrees: what continues a bone is seen from the bone's joint within this angle of its
/// direction.
inline constexpr double aheadCosine = 0.7;

/// What a frame, one or several bones that move as one, has to do with a skin, and how it moves in the swings
/// of the joints. Lengths in scene units, at rest.
struct FrameInfluence {
    SkinInfluence influence;
    std::vector<std::size_t> bodies; ///< its bones, or its muscles if it has none
    std::vector<Vec3> nearest;       ///< #V: nearest point of these bodies
    Eigen::AlignedBox3d box;         ///< their bounds
    double extent = 0;               ///< diagonal of the bounds, scene units
    std::size_t moves = 0;           ///< number of swings that move it: its depth in the hierarchy of joints
    Vec3 joint =
        Vec3::Zero(); ///< fixed point of its own swings (least squares); the centre of the bounds for a slide
    bool twists = false; ///< it turns about its own length, as seen from its parent
};

/// The parent bone in the hierarchy of joints: the nearest one that moves in fewer swings; null: none.
const FrameInfluence* parentBone(const std::vector<FrameInfluence>& influences, std::size_t bone);

} // namespace tss
