#include "bake/motion/CellTools.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Minimum over the cell of the term of DOF k on the left side of a plane.
double least(const LimitPlane& plane, const Cell& cell, std::size_t k) {
    const double c = plane.coefficients[k];
    return c * (c > 0 ? cell.lower[k] : cell.upper[k]);
}

/// Tightens the range of every DOF by one plane (interval propagation); rounding is allowed for, so that
/// poses on the plane itself stay in. False where the cell is outside altogether.
bool shrink(const LimitPlane& plane, Cell& cell, std::size_t dofs) {
    double sum = 0, size = std::abs(plane.bound);
    for (std::size_t k = 0; k < dofs; ++k) {
        sum += least(plane, cell, k);
        size += std::abs(plane.coefficients[k]) * std::max(std::abs(cell.lower[k]), std::abs(cell.upper[k]));
    }
    const double bound = plane.bound + 1e-14 * size;
    if (sum > bound) return false;
    for (std::size_t k = 0; k < dofs; ++k) {
        const double c = plane.coefficients[k];
        const double left = bound - (sum - least(plane, cell, k));
        if (c > 0) cell.upper[k] = std::max(cell.lower[k], std::min(cell.upper[k], left / c));
        if (c < 0) cell.lower[k] = std::min(cell.upper[k], std::max(cell.lower[k], left / c));
    }
    return true;
}

} // namespace

bool shrinkToPlanes(const Motion& motion, Cell& cell) {
    for (const LimitPlane& plane : motion.planes)
        if (!shrink(plane, cell, motion.dofCount())) return false;
    return true;
}

std::pair<Cell, Cell> splitCell(const MotionRates& rates, const Cell& cell, std::size_t dof) {
    std::pair<Cell, Cell> halves{cell, cell};
    halves.first.upper[dof] = halves.second.lower[dof] = rates.cut(dof, cell.lower[dof], cell.upper[dof]);
    return halves;
}

bool canSplit(const Cell& cell, std::size_t dof) {
    return std::nextafter(cell.lower[dof], cell.upper[dof]) < cell.upper[dof];
}

std::size_t widestDof(const CellMotion& motion, const Vec3& centre, double radius) {
    auto share = motion.shares(motion.centrePose() * centre);
    for (std::size_t k = 0; k < motion.dofs(); ++k) share[k] += motion.relativeShare(k) * radius;
    return static_cast<std::size_t>(std::max_element(share.begin(), share.begin() + motion.dofs()) -
                                    share.begin());
}

} // namespace tss
