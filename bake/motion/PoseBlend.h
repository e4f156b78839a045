#pragma once
// Kavan, Collins, Zara and O'Sullivan, "Skinning with dual quaternions", 2007.
#include "bake/motion/Motion.h"

#include <Eigen/Geometry>

namespace tss {

/// A rigid motion as a unit dual quaternion, so that motions can be mixed: a mean of rotations about one axis
/// is a rotation about that axis, where a mean of matrices would shrink what it moves.
struct DualPose {
    Eigen::Vector4d real{0, 0, 0, 1}; ///< x, y, z, w of the rotation
    Eigen::Vector4d dual{0, 0, 0, 0}; ///< half the translation times the rotation

    DualPose() = default;
    explicit DualPose(const Pose& pose) {
        const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
        const Vec3 t = 0.5 * pose.translation();
        real = q.coeffs();
        dual = (Eigen::Quaterniond(0, t.x(), t.y(), t.z()) * q).coeffs();
    }
};

/// The mean of some motions, weighted by shares. What the shares leave to 1 stays where it is.
class PoseBlend {
public:
    void add(double share, const DualPose& pose) {
        // A rotation is two quaternions: the one on the side of what is there already, at first of rest.
        const double side = real_.isZero() ? pose.real[3] : real_.dot(pose.real);
        const double signed_ = side < 0 ? -share : share;
        real_ += signed_ * pose.real;
        dual_ += signed_ * pose.dual;
        left_ -= share;
    }

    /// A mean that is no rotation (opposite ones in equal shares) is rest.
    Pose pose() const {
        Eigen::Vector4d real = real_;
        real[3] += real[3] < 0 ? -std::max(left_, 0.0) : std::max(left_, 0.0);
        const double length = real.norm();
        if (!(length > 1e-9)) return Pose::Identity();
        const Eigen::Quaterniond q(Eigen::Vector4d(real / length)), d(Eigen::Vector4d(dual_ / length));
        Pose result = Pose::Identity();
        result.linear() = q.toRotationMatrix();
        result.translation() = 2 * (d * q.conjugate()).vec();
        return result;
    }

private:
    Eigen::Vector4d real_{0, 0, 0, 0}, dual_{0, 0, 0, 0};
    double left_ = 1;
};

/// Part of the way from one motion to another. A share of 0 is the first bit for bit.
inline Pose blendBetween(const Pose& from, const Pose& to, double share) {
    if (share == 0 || from.matrix() == to.matrix()) return from;
    PoseBlend blend;
    blend.add(share, DualPose(from.inverse(Eigen::Isometry) * to));
    return from * blend.pose();
}

} // namespace tss
