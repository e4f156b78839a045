#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <Eigen/Geometry>

#include <cmath>

namespace tss {

/// The smallest turn that takes the direction of one vector to that of the other, neither of them zero; of
/// opposite ones a half turn about some axis. Right to rounding also where they are nearly opposite, where
/// Eigen's FromTwoVectors is off by up to 1e-5 and no turn any more.
inline Eigen::Quaterniond turnBetween(const Vec3& from, const Vec3& to) {
    const Vec3 a = from.normalized(), b = to.normalized();
    Vec3 axis = a.cross(b);
    const double sine = axis.norm();
    if (!(sine > 1e-15)) return Eigen::Quaterniond::FromTwoVectors(a, b).normalized();
    axis /= sine;
    axis -= axis.dot(a) * a; // of a short one little is right
    return Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(sine, a.dot(b)), axis.normalized()));
}

} // namespace tss
