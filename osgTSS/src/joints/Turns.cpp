#include "Turns.h"

#include <algorithm>
#include <cmath>

namespace osgTSS {

std::array<double, 3> turnsOf(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes) {
    const auto [a, b, c] = axes;
    const double hand = (a + 1) % 3 == b ? 1 : -1;
    return {std::atan2(-hand * rotation(b, c), rotation(c, c)),
            std::asin(std::clamp(hand * rotation(a, c), -1.0, 1.0)),
            std::atan2(-hand * rotation(a, b), rotation(a, a))};
}

} // namespace osgTSS
