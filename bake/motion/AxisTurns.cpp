#include "bake/motion/AxisTurns.h"

#include "bake/base/Degrees.h"
#include "bake/motion/WholeTurn.h"

#include <algorithm>
#include <cmath>

namespace tss {

std::array<double, 3> turnsOf(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes) {
    const auto [a, b, c] = axes;
    const double hand = (a + 1) % 3 == b ? 1 : -1;
    return {std::atan2(-hand * rotation(b, c), rotation(c, c)),
            std::asin(std::clamp(hand * rotation(a, c), -1.0, 1.0)),
            std::atan2(-hand * rotation(a, b), rotation(a, a))};
}

bool addTurns(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes, bool first,
              std::array<std::vector<double>, 3>& run) {
    const double mostMiddle = toRadians(80.0);
    const std::array<double, 3> angles = turnsOf(rotation, axes);
    if (std::abs(angles[1]) > mostMiddle) return false;
    for (std::size_t k = 0; k < 3; ++k) run[k].push_back(nearestTurn(angles[k], first ? 0 : run[k].back()));
    return true;
}

} // namespace tss
