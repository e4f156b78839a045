#pragma once
#include "bake/spheres/SphereSet.h"

namespace tss {

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
