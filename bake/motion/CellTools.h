#pragma once
#include "bake/motion/MotionBound.h"

#include <utility>

namespace tss {

/// Shrinks a cell to the box about its part inside the limit planes. False: no part of it is inside.
bool shrinkToPlanes(const Motion& motion, Cell& cell);

/// Cuts a cell in two along one DOF.
std::pair<Cell, Cell> splitCell(const MotionRates& rates, const Cell& cell, std::size_t dof);

/// Whether there is a double strictly between the ends of the cell along a DOF. Path values that are large
/// beside their range, as time stamps are, run out of doubles early.
bool canSplit(const Cell& cell, std::size_t dof);

/// The DOF that moves some point of a ball of B (in B's frame) most in the cell of `motion`, the one to
/// split. The ball's centre alone is not enough: a DOF about an axis through it would never be split.
std::size_t widestDof(const CellMotion& motion, const Vec3& centre, double radius);

} // namespace tss
