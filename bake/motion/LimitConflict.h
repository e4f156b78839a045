#pragma once
#include "bake/motion/Motion.h"

namespace tss {

/// The limit planes that together leave no value of the DOFs within their limits, no fewer of them would:
/// their places in motion.planes, rising; none where some value meets them all, give or take 1e-9 of the
/// ranges and rounding, so that a coupling by two planes that face each other is no conflict. For motions of
/// at most maxDofs DOFs that are finite.
std::vector<std::size_t> conflictingPlanes(const Motion& motion);

/// The same plane with a largest coefficient of 1 to 2, whose squares are numbers: a power of two times it.
LimitPlane inReach(LimitPlane plane);

} // namespace tss
