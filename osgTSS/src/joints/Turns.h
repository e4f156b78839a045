#pragma once
#include "bake/motion/Motion.h"

#include <array>

namespace osgTSS {

/// Angles (radians) of turns about three different coordinate axes (0 X, 1 Y, 2 Z) whose product, the first
/// outermost as columns, is the rotation: R = R(axes[0], out[0]) R(axes[1], out[1]) R(axes[2], out[2]). The
/// middle angle is within a quarter turn of 0.
std::array<double, 3> turnsOf(const Eigen::Matrix3d& rotation, const std::array<int, 3>& axes);

} // namespace osgTSS
