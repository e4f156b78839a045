#pragma once
#include "bake/respond/SkinContact.h"

#include <cstdint>
#include <vector>

namespace tss {

/// Leaves out look-ups that would find nothing that pushes. Most contacts of a skin stay clear of it for many
/// updates: after a look-up the next one is due when what was looked at has moved, one against the other,
/// half as far as the plane found was from pushing, or, where nothing was near, as far as that was.
/// Contacts are numbered as the rig has them: rows, then pokes, then folds.
class SkinWatch {
public:
    explicit SkinWatch(const SkinRig& rig);

    /// slack: how far the skin is from the plane that was found last, scene units; < 0: beyond it.
    bool due(const SkinRig& rig, const SkinScene& scene, std::size_t contact, float slack) const;

    /// What a look-up found.
    void note(const SkinRig& rig, const SkinScene& scene, std::size_t contact, const SkinContact& found);

    /// All are due.
    void forget();

private:
    struct Seen {
        Eigen::Vector3f place = Eigen::Vector3f::Zero();   ///< of the point looked up, from what it met
        Eigen::Vector3f weights = Eigen::Vector3f::Zero(); ///< of that, in `triangle`
        Eigen::Vector3f normal = Eigen::Vector3f::Zero();
        int triangle = -1; ///< -1: nothing was near, `place` is the point's own
        float clear = 0;   ///< then: how far it was from near; 0: due
        double path = 0;   ///< and PlacedMuscle::path
    };

    std::vector<Seen> seen_;
};

} // namespace tss
