#pragma once
#include "bake/motion/Motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace tss {

/// Whether the limits span exactly one whole turn: the DOF is periodic and has no end.
inline bool wholeTurn(const Dof& dof) {
    constexpr double turn = 2 * std::numbers::pi;
    return dof.kind == DofKind::Rotation && std::abs(dof.upper - dof.lower - turn) <= 1e-6 * turn;
}

/// The same set of poses without repetitions: the limits of rotations by more than a whole turn are cut to
/// one turn about rest, and a billionth of a turn more, which covers rounding. Unchanged where there are
/// planes, whose couplings are not periodic.
inline Motion onceRound(Motion motion) {
    constexpr double turn = (1 + 1e-9) * 2 * std::numbers::pi;
    for (Dof& dof : motion.dofs) {
        if (dof.kind != DofKind::Rotation || dof.upper - dof.lower <= turn || !motion.planes.empty())
            continue;
        dof.lower = std::max(dof.lower, std::min(dof.rest - turn / 2, dof.upper - turn));
        dof.upper = std::min(dof.upper, dof.lower + turn);
    }
    return motion;
}

/// The angle that differs from `value` by whole turns and is nearest to `to`.
inline double nearestTurn(double value, double to) {
    constexpr double turn = 2 * std::numbers::pi;
    return value + turn * std::round((to - value) / turn);
}

/// Brings the values of periodic DOFs within their limits by whole turns; others stay, all where there are
/// planes.
inline void wrapTurns(const Motion& motion, std::span<double> values) {
    if (!motion.planes.empty()) return;
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        if (wholeTurn(dof)) values[k] = nearestTurn(values[k], (dof.lower + dof.upper) / 2);
    }
}

} // namespace tss
