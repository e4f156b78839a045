#pragma once
#include "bake/respond/SkinPushes.h"

namespace tss {

/// Keeps contacts from turning triangles of the skin over: where pushes would, those around are made smaller
/// until they do not, in a bounded number of rounds. What is turned over without them is left as it is.
/// Continuous in the pushes, and without history.
class SkinTurnLimit {
public:
    /// Keeps a reference to the rig.
    explicit SkinTurnLimit(const SkinRig& rig);

    /// Limits the displacements that pushes have just applied to the skin of a scene. blocks: those that they
    /// may have displaced. Returns whether any became smaller.
    bool limit(SkinScene& scene, SkinPushes& pushes, std::span<char> blocks);

private:
    void findTriangles(const SkinScene& scene, std::span<const char> blocks);
    bool findFactors(const SkinScene& scene);

    /// A triangle beside displaced skin that is not turned over as the skin is carried.
    struct Beside {
        Tri corners{0, 0, 0};
        Eigen::Vector3f normal = Eigen::Vector3f::Zero(); ///< unit, the mean of the skin's at its corners
        float area = 0;                                   ///< as carried, seen along the normal
    };
    const SkinRig& rig_;
    std::vector<Beside> beside_;
    std::vector<float> factors_; ///< per node: of its displacement
};

} // namespace tss
