#pragma once
#include "bake/motion/Motion.h"

namespace tss {

/// A minimal infeasible subset of the limit planes: planes that no value within the limits satisfies
/// together, while without any one of them some value does. Indices into motion.planes, rising; empty where
/// some value satisfies all planes up to 1e-9 of the ranges and rounding, so that an equality written as two
/// opposite planes is no conflict. The motion must have finite limits and at most maxDofs DOFs.
std::vector<std::size_t> conflictingPlanes(const Motion& motion);

/// The same plane scaled by a power of two, so that its largest coefficient lies in [1, 2) and squares of
/// coefficients neither overflow nor vanish.
LimitPlane rescaled(LimitPlane plane);

} // namespace tss
