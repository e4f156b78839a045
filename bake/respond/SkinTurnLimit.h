#pragma once
#include "bake/respond/SkinPushes.h"

namespace tss {

/// Keeps contacts from turning triangles of the skin over. Where their pushes would, the displacements around
/// are first brought nearer to the largest of them, so that what is pushed out of a body takes its
/// surroundings along; where that does not do, they are made smaller until none turns over. Both in a bounded
/// number of rounds. A triangle is turned over where it faces away from its normal at rest as bones turn its
/// first corner (SkinFollowing counts them so); one that is without pushes is left as it is. Without history.
class SkinTurnLimit {
public:
    /// Keeps a reference to the rig.
    explicit SkinTurnLimit(const SkinRig& rig) : rig_(rig), wishes_(rig.foundation.nodes, {}) {}

    /// Limits the displacements that pushes have just applied to the skin of a scene. Returns whether any has
    /// changed.
    bool limit(SkinScene& scene, SkinPushes& pushes);

private:
    /// A triangle beside displaced skin that is not turned over as the skin is carried.
    struct Beside {
        Tri corners{0, 0, 0};
        Eigen::Vector3f normal =
            Eigen::Vector3f::Zero(); ///< unit, at rest, turned as bones turn its first corner
        float area = 0;              ///< as carried, seen along the normal
    };
    /// What the triangles at a node that pushes would turn over ask of it.
    struct Wish {
        float part = 1;         ///< of the differences between displacements that all of them can stand
        float sum = 0;          ///< of 1 - part over the triangles
        Move to = Move::Zero(); ///< sum of what they bring the displacement nearer to, each times 1 - part
    };
    void findTriangles(const SkinScene& scene, const SkinPushes& pushes);
    void findWishes(const SkinScene& scene, const SkinPushes& pushes, bool gathers);

    const SkinRig& rig_;
    std::vector<Beside> beside_;
    SparseSums<Wish> wishes_; ///< over nodes
};

} // namespace tss
