#pragma once
#include "bake/motion/MotionBound.h"

#include <utility>

namespace tss {

/// Shrinks a cell to the box about its part inside the limit planes. False: no part of it is inside.
bool shrinkToPlanes(const Motion& motion, Cell& cell);

/// Cuts a cell in two along one DOF.
std::pair<Cell, Cell> splitCell(const MotionRates& rates, const Cell& cell, std::size_t dof);

/// Whether doubles have a value between the ends along a DOF, to cut at: of a path whose values are large
/// beside their range (time stamps) they end early.
bool canSplit(const Cell& cell, std::size_t dof);

/// The DOF that moves some point of a ball of B (in B's frame) most, in the cell of `motion`. Of the centre
/// alone it would not do: where that comes to lie on an axis, its DOF would never be cut.
std::size_t widestDof(const CellMotion& motion, const Vec3& centre, double radius);

} // namespace tss
