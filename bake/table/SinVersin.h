#pragma once
#include <bit>
#include <cstdint>

namespace tss {

/// What sin x and 1 - cos x are made of. Quadrants of pi/2 are taken off in two parts, the first of 33 bits
/// so that its multiples are exact; within one, the Taylor series has no error left that counts.
struct SineSeries {
    double perTurn = 0.63661977236758134308; ///< quadrants a radian
    double shift = 0x1.8p52; ///< adding it rounds to an integer, which is then in the last bits
    double high = 0x1.921fb544p+0, low = 0x1.0b4611a626331p-34;
    /// sin r = r + r z (sine[0] + sine[1] z + ...), 1 - cos r = z (versine[0] + versine[1] z + ...), z = r^2
    double sine[8] = {-1.0 / 6,
                      1.0 / 120,
                      -1.0 / 5040,
                      1.0 / 362880,
                      -1.0 / 39916800,
                      1.0 / 6227020800.0,
                      -1.0 / 1307674368000.0,
                      1.0 / 355687428096000.0};
    double versine[8] = {0.5,           -1.0 / 24,         1.0 / 720,           -1.0 / 40320,
                         1.0 / 3628800, -1.0 / 479001600., 1.0 / 87178291200.0, -1.0 / 20922789888000.0};
};

/// sin x and 1 - cos x to 2 units in the last place of max(|value|, x^2/2): a third of the time that libm
/// takes for sin and cos, and no cancellation for small turns. x: radians, any size up to 1e5 (METHOD 4,
/// features).
inline void sinVersin(double x, double& sine, double& versine) {
    constexpr SineSeries series;
    const double shifted = x * series.perTurn + series.shift, turns = shifted - series.shift;
    const double r = (x - turns * series.high) - turns * series.low;
    const double z = r * r, z2 = z * z, z4 = z2 * z2;
    // Sums of sums, so that few terms wait for one another.
    const auto sum = [&](const double(&c)[8]) {
        return ((c[0] + z * c[1]) + z2 * (c[2] + z * c[3])) +
               z4 * ((c[4] + z * c[5]) + z2 * (c[6] + z * c[7]));
    };
    const double s = r + r * z * sum(series.sine), v = z * sum(series.versine);
    // By quadrant, without a branch: which of the two is the sine, and what is added to the other.
    constexpr double sign[4] = {1, 1, -1, -1}, base[4] = {0, 1, 2, 1};
    const unsigned quadrant = static_cast<unsigned>(std::bit_cast<std::uint64_t>(shifted)) & 3;
    const double sines[2] = {s, 1 - v}, rests[2] = {v, s};
    sine = sign[quadrant] * sines[quadrant & 1];
    versine = base[quadrant] + sign[quadrant] * rests[quadrant & 1];
}

} // namespace tss
