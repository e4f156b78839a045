#pragma once
#include <cstddef>
#include <vector>

namespace tss {

/// How truly skin follows the bones that it lies on, whatever carries it.
struct SkinFollowing {
    /// Skin that lies on one bone alone: how far it is off the bone's own motion, in thousandths of the
    /// bones' bounding diagonal.
    struct OnBone {
        std::size_t vertices = 0;
        double mean = 0;
        double most = 0; ///< 95 % of the vertices are within it
    };
    std::vector<OnBone> bones;        ///< one per body; none lies on a muscle
    double shortest = 1, longest = 1; ///< edges, of their length at rest: 1st and 99th percentile
    std::size_t turnedOver = 0;       ///< triangles that lie upside down against the skin's own turn

    /// Takes the worse of each figure.
    void worsen(const SkinFollowing& other);
};

} // namespace tss
