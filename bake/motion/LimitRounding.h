#pragma once
#include "bake/motion/Motion.h"

#include <algorithm>
#include <cmath>

namespace tss {

/// What files round limits and values by, as floats.
inline constexpr double fileRounding = 2e-7;

/// How far beyond the limits of a DOF a value may be that only rounding has put there, where limits and
/// values are rounded to this share of themselves: far from 0 no more than a ten-thousandth of the range, for
/// beyond that other poses begin.
inline double limitRounding(const Dof& dof, double share) {
    const double rounding = share * std::max(std::abs(dof.lower), std::abs(dof.upper));
    const double range = dof.upper - dof.lower;
    return range > 0 ? std::min(rounding, 1e-4 * range) : rounding;
}

} // namespace tss
