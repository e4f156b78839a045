#include "bake/motion/TurnBetween.h"

#include <cmath>

namespace tss {

Eigen::Quaterniond turnBetween(const Vec3& from, const Vec3& to) {
    const Vec3 a = from.normalized(), b = to.normalized();
    Vec3 axis = a.cross(b);
    const double cosine = a.dot(b);
    if (cosine >= 0) { // by half of the angle, without a trigonometric function
        const double half = std::sqrt(0.5 * (1 + cosine));
        axis *= 0.5 / half;
        return Eigen::Quaterniond(half, axis.x(), axis.y(), axis.z()).normalized();
    }
    const double sine = axis.norm();
    if (!(sine > 1e-15)) { // opposite
        const Vec3 across = a.unitOrthogonal();
        return {0, across.x(), across.y(), across.z()};
    }
    axis /= sine;
    axis -= axis.dot(a) * a; // of a short one little is right
    return Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(sine, cosine), axis.normalized()));
}

} // namespace tss
