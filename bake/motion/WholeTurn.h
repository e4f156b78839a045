#pragma once
#include "bake/motion/Motion.h"

#include <cmath>
#include <numbers>

namespace tss {

/// Whether the limits are one whole turn: the joint goes on where they meet, and has no end.
inline bool wholeTurn(const Dof& dof) {
    constexpr double turn = 2 * std::numbers::pi;
    return dof.kind == DofKind::Rotation && std::abs(dof.upper - dof.lower - turn) <= 1e-6 * turn;
}

/// The angle that differs from `value` by whole turns and is nearest to `to`.
inline double nearestTurn(double value, double to) {
    constexpr double turn = 2 * std::numbers::pi;
    return value + turn * std::round((to - value) / turn);
}

} // namespace tss
