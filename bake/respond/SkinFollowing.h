#pragma once
#include <cstddef>
#include <vector>

namespace tss {

/// How closely skin follows the bones that it lies on.
struct SkinFollowing {
    /// Distance of skin that lies on one bone alone from where the bone's motion takes it, in thousandths of
    /// the bones' bounding diagonal.
    struct OnBone {
        std::size_t vertices = 0;
        double mean = 0;
        double most = 0; ///< 95 % of the vertices are within it
    };
    std::vector<OnBone> bones;        ///< one per body; none lies on a muscle
    double shortest = 1, longest = 1; ///< edges, of their length at rest: 1st and 99th percentile
    std::size_t turnedOver = 0; ///< triangles that are flipped relative to the rotation of the skin there

    /// Takes the worse of each figure.
    void worsen(const SkinFollowing& other);
};

} // namespace tss
