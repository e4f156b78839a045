#pragma once
#include "bake/motion/Motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tss {

/// The limits of a DOF divided into parts of equal width.
struct EvenParts {
    double lower = 0, width = 0; ///< of the first part
};

/// The parts extend slightly beyond the limits, so that a value that rounding puts outside still lies in a
/// part, and so that parts of a DOF without a range have a width.
inline EvenParts evenParts(const Dof& dof, std::uint32_t count) {
    const double range = dof.upper - dof.lower;
    const double size = std::max(std::abs(dof.lower), std::abs(dof.upper));
    const double over = 1e-9 * range + 4 * std::numeric_limits<double>::epsilon() * size + 1e-290;
    return {dof.lower - over, (range + 2 * over) / count};
}

} // namespace tss
