#pragma once
#include <Eigen/Core>

#include <array>
#include <vector>

namespace tss {

/// Angles (radians) of turns about three different coordinate axes (0 X, 1 Y, 2 Z) whose product, the first
/// outermost as columns, is the rotation: R = R(axes[0], out[0]) R(axes[1], out[1]) R(axes[2], out[2]). The
/// middle angle is within a quarter turn of 0.
std::array<double, 3> turnsOf(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes);

/// Adds the angles of a rotation to those of a run of them, without jumps from the one before; first: of the
/// run. False where the middle angle comes near a quarter turn, where the others are not told apart.
bool addTurns(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes, bool first,
              std::array<std::vector<double>, 3>& run);

} // namespace tss
