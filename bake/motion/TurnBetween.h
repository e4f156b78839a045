#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <Eigen/Geometry>

namespace tss {

/// The smallest turn that takes the direction of one vector to that of the other, neither of them zero; of
/// opposite ones a half turn about some axis. Right to rounding also where they are nearly opposite, where
/// Eigen's FromTwoVectors is off by up to 1e-5 and no turn any more; nor does it cost what includes it a
/// decomposition.
Eigen::Quaterniond turnBetween(const Vec3& from, const Vec3& to);

} // namespace tss
