#pragma once
#include <cmath>

namespace tss {

/// sin x and 1 - cos x to 2 units in the last place of max(|value|, x^2/2): a third of the time that libm
/// takes for sin and cos, and no cancellation for small turns. x: radians, any size up to 1e5 (METHOD 4,
/// features).
inline void sinVersin(double x, double& sine, double& versine) {
    // Quadrants of pi/2 in two parts, the first of 33 bits so that its multiples are exact; within one, the
    // Taylor series has no error left that counts.
    constexpr double high = 0x1.921fb544p+0, low = 0x1.0b4611a626331p-34;
    const double turns = std::nearbyint(x * 0.63661977236758134308);
    const double r = (x - turns * high) - turns * low;
    const double z = r * r, z2 = z * z, z4 = z2 * z2;
    const double s1 = -1.0 / 6 + z * (1.0 / 120);
    const double s2 = -1.0 / 5040 + z * (1.0 / 362880);
    const double s3 = -1.0 / 39916800 + z * (1.0 / 6227020800.0);
    const double s4 = -1.0 / 1307674368000.0 + z * (1.0 / 355687428096000.0);
    const double s = r + r * z * ((s1 + z2 * s2) + z4 * (s3 + z2 * s4));
    const double v1 = 0.5 - z * (1.0 / 24);
    const double v2 = 1.0 / 720 - z * (1.0 / 40320);
    const double v3 = 1.0 / 3628800 - z * (1.0 / 479001600);
    const double v4 = 1.0 / 87178291200.0 - z * (1.0 / 20922789888000.0);
    const double v = z * ((v1 + z2 * v2) + z4 * (v3 + z2 * v4));
    switch (static_cast<int>(static_cast<long long>(turns) & 3)) {
    case 0:
        sine = s;
        versine = v;
        break;
    case 1:
        sine = 1 - v;
        versine = 1 + s;
        break;
    case 2:
        sine = -s;
        versine = 2 - v;
        break;
    default:
        sine = v - 1;
        versine = 1 - s;
        break;
    }
}

} // namespace tss
