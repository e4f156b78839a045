#pragma once
#include "bake/motion/MotionBound.h"

#include <utility>

namespace tss {

/// Shrinks a cell to the box about its part inside the limit planes. False: no part of it is inside.
bool shrinkToPlanes(const Motion& motion, Cell& cell);

/// Cuts a cell in two along one DOF.
std::pair<Cell, Cell> splitCell(const MotionRates& rates, const Cell& cell, std::size_t dof);

} // namespace tss
