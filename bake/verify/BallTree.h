#pragma once
#include "bake/spheres/SphereSet.h"

#include <cstdint>

namespace tss::verify {

/// Balls about balls, down to the spheres of a set.
struct BallTree {
    struct Ball {
        Vec3 centre = Vec3::Zero();
        double radius = 0;
        std::int32_t first = -1, second = -1; ///< children; -1 for a sphere
        std::uint32_t sphere = 0;
    };
    std::vector<Ball> balls; ///< the root is the last; empty for an empty set

    explicit BallTree(const SphereSet& spheres);
    std::int32_t root() const { return static_cast<std::int32_t>(balls.size()) - 1; }

private:
    std::int32_t join(const SphereSet& spheres, std::vector<std::uint32_t>& order, std::size_t from,
                      std::size_t to);
};

} // namespace tss::verify
