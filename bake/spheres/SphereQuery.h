#pragma once
#include "bake/geometry/Bvh.h"
#include "bake/spheres/SphereSet.h"

#include <span>

namespace tss {

/// Finds the sphere of a set whose surface is nearest to a point. Keeps a copy of the spheres; immutable.
class SphereQuery {
public:
    explicit SphereQuery(std::span<const Sphere> spheres);

    struct Nearest {
        double gap =
            std::numeric_limits<double>::infinity(); ///< |x - c| - r, negative inside; infinity: no sphere
        int sphere = -1;
    };

    /// The sphere with the least gap to x, or the first one found with a gap <= enough.
    Nearest nearest(const Vec3& x, double enough = -std::numeric_limits<double>::infinity()) const;

    /// Some sphere contains x.
    bool contains(const Vec3& x) const;

    const Sphere& operator[](int sphere) const { return spheres_[static_cast<std::size_t>(sphere)]; }

private:
    double lowerBound(std::uint32_t node, const Vec3& x) const;

    SphereSet spheres_;
    Bvh bvh_;                                  ///< over the boxes of the spheres
    std::vector<Eigen::AlignedBox3d> centres_; ///< of the centres under each node
    std::vector<double> largest_;              ///< largest radius under each node
};

} // namespace tss
