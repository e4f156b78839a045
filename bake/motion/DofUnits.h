#pragma once
#include "bake/base/Degrees.h"
#include "bake/motion/Motion.h"

#include <algorithm>
#include <cmath>

namespace tss {

/// Values of a DOF as people and files write them: degrees for rotations, else as they are.
inline double toUser(const Dof& dof, double q) {
    return dof.kind == DofKind::Rotation ? toDegrees(q) : q;
}
inline double fromUser(const Dof& dof, double value) {
    return dof.kind == DofKind::Rotation ? toRadians(value) : value;
}

/// What files round limits and values by, as floats.
inline constexpr double fileRounding = 2e-7;

/// Rounding at the limits of a DOF, no more than a ten-thousandth of the range: beyond that other poses
/// begin.
inline double belowRange(const Dof& dof, double rounding) {
    const double range = dof.upper - dof.lower;
    return range > 0 ? std::min(rounding, 1e-4 * range) : rounding;
}

/// How far beyond the limits of a DOF a value may be that only rounding has put there, where limits and
/// values are rounded to this share of themselves.
inline double limitRounding(const Dof& dof, double share) {
    return belowRange(dof, share * std::max(std::abs(dof.lower), std::abs(dof.upper)));
}

} // namespace tss
