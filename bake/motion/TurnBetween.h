#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <Eigen/Geometry>

namespace tss {

/// The smallest rotation that takes the direction of one vector to that of the other, neither of them zero;
/// of opposite ones a half turn about some axis. Accurate to rounding also for nearly opposite vectors, for
/// which Eigen's FromTwoVectors is off by up to 1e-5 and not of unit length, and without its header's SVD.
Eigen::Quaterniond turnBetween(const Vec3& from, const Vec3& to);

} // namespace tss
