#pragma once
#include "bake/respond/SkinFollowing.h"
#include "bake/respond/SkinRig.h"

namespace tss {

/// Measures how truly skin follows its bones. Skin lies on a bone alone when it is nearer to it than a
/// thirtieth of the bones' diagonal and farther than a ninth from every other. Keeps references to skin and
/// rig.
class SkinFollowMeasure {
public:
    /// bodies: those that the rig was made with.
    SkinFollowMeasure(const TriangleMesh& skin,
                      const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies, const SkinRig& rig);

    /// positions: of the rig's touched vertices. poses: one per body, its motion since rest, in the skin's
    /// frame; empty: none moves.
    SkinFollowing at(std::span<const Vec3> positions, std::span<const Pose> poses) const;

private:
    const TriangleMesh& skin_;
    const SkinRig& rig_;
    double size_ = 0;                               ///< diagonal of the bones' bounds, scene units
    std::vector<std::vector<std::uint32_t>> alone_; ///< #bodies, vertices of the skin mesh
};

} // namespace tss
