#pragma once
#include "bake/motion/Motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace tss {

/// The limits of a DOF in parts of equal width.
struct EvenParts {
    double lower = 0, width = 0; ///< of the first part
};

/// They reach a little over the limits, so that what rounding puts beyond those lies in a part, and so that a
/// DOF without a range has a width.
inline EvenParts evenParts(const Dof& dof, std::uint32_t count) {
    const double range = dof.upper - dof.lower;
    const double size = std::max(std::abs(dof.lower), std::abs(dof.upper));
    const double over = 1e-9 * range + 4 * std::numeric_limits<double>::epsilon() * size + 1e-290;
    return {dof.lower - over, (range + 2 * over) / count};
}

} // namespace tss
