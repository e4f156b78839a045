#pragma once
#include "bake/base/NearestFloat.h"
#include "bake/spheres/SphereSet.h"

#include <cmath>
#include <limits>

namespace tss {

/// The least float that is not below a number; inf above the largest float.
inline float floatAbove(double number) {
    const float nearest = static_cast<float>(number);
    return nearest < number ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

/// The sphere as scene files store it, centre and diameter in float. It contains the given one, and so does
/// every set of them what the set covered; the radius grows by at most the rounding of the centre and of the
/// diameter. A table's proof is about exact numbers: round before the search, not after it.
inline Sphere roundToFloat(const Sphere& sphere) {
    Sphere rounded;
    for (int k = 0; k < 3; ++k) rounded.centre[k] = nearestFloat(sphere.centre[k]);
    if (rounded.centre == sphere.centre && isFloat(2 * sphere.radius)) return sphere;
    const double shift = (rounded.centre - sphere.centre).norm();
    const double grown = (sphere.radius + shift) * (1 + 4 * std::numeric_limits<double>::epsilon());
    rounded.radius = double(floatAbove(2 * grown)) / 2;
    return rounded;
}

inline SphereSet roundToFloat(SphereSet spheres) {
    for (Sphere& sphere : spheres) sphere = roundToFloat(sphere);
    return spheres;
}

} // namespace tss
