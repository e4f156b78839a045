#pragma once
#include <cmath>
#include <numbers>

namespace tss {

/// Files hold degrees, the core radians.
inline double toRadians(double degrees) {
    return degrees * (std::numbers::pi / 180);
}
inline double toDegrees(double radians) {
    return radians * (180 / std::numbers::pi);
}

/// Degrees that toRadians() takes back to exactly these radians, or where no double does, to the nearest
/// value on the side of `inside`: so a limit that was proven is never widened by writing it down.
inline double degreesInside(double radians, double inside) {
    double degrees = toDegrees(radians);
    for (int side : {0, -1, 1, -2, 2}) {
        double near = degrees;
        for (int k = 0; k < std::abs(side); ++k) near = std::nextafter(near, side < 0 ? -INFINITY : INFINITY);
        if (toRadians(near) == radians) return near;
    }
    const bool upwards = inside > radians;
    while (upwards ? toRadians(degrees) < radians : toRadians(degrees) > radians)
        degrees = std::nextafter(degrees, upwards ? INFINITY : -INFINITY);
    return degrees;
}

} // namespace tss
