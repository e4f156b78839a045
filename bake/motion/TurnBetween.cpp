#include "bake/motion/TurnBetween.h"

#include <cmath>

namespace tss {

Eigen::Quaterniond turnBetween(const Vec3& from, const Vec3& to) {
    const Vec3 a = from.normalized(), b = to.normalized();
    Vec3 axis = a.cross(b);
    const double sine = axis.norm();
    if (!(sine > 1e-15)) return Eigen::Quaterniond::FromTwoVectors(a, b).normalized();
    axis /= sine;
    axis -= axis.dot(a) * a; // of a short one little is right
    return Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(sine, a.dot(b)), axis.normalized()));
}

} // namespace tss
