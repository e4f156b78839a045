#pragma once
#include "bake/motion/Motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace tss {

inline constexpr double fullTurn = 2 * std::numbers::pi; ///< radians

/// Whether the limits span exactly one whole turn: the DOF is periodic and has no end.
inline bool wholeTurn(const Dof& dof) {
    return dof.kind == DofKind::Rotation && std::abs(dof.upper - dof.lower - fullTurn) <= 1e-6 * fullTurn;
}

/// The limits of a rotation that has none: half a turn to either side of 0.
inline void setWholeTurn(Dof& dof) {
    dof.lower = -fullTurn / 2;
    dof.upper = fullTurn / 2;
}

/// A DOF's limits; of a periodic one half a turn to either side of rest.
inline std::array<double, 2> limitsAboutRest(const Dof& dof) {
    if (wholeTurn(dof)) return {dof.rest - fullTurn / 2, dof.rest + fullTurn / 2};
    return {dof.lower, dof.upper};
}

/// The same set of poses without repetitions: the limits of rotations by more than a whole turn are cut to
/// one turn about rest, and a billionth of a turn more, which covers rounding. Unchanged where there are
/// planes, whose couplings are not periodic.
inline Motion onceRound(Motion motion) {
    constexpr double turn = (1 + 1e-9) * fullTurn;
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
    return value + fullTurn * std::round((to - value) / fullTurn);
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
