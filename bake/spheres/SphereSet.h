#pragma once
#include "bake/geometry/TriangleMesh.h"

namespace tss {

struct Sphere {
    Vec3 centre; ///< scene units, in the body's own frame
    double radius = 0;
};

/// The spheres that stand for one body (the paper's Ms).
using SphereSet = std::vector<Sphere>;

/// The smallest ball that contains two balls.
inline Sphere ballAround(const Sphere& a, const Sphere& b) {
    const Vec3 between = b.centre - a.centre;
    const double distance = between.norm();
    if (distance + b.radius <= a.radius) return a;
    if (distance + a.radius <= b.radius) return b;
    const double radius = 0.5 * (distance + a.radius + b.radius);
    return {a.centre + between * ((radius - a.radius) / distance), radius};
}

} // namespace tss
