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
    /// The one of less than half a turn.
    explicit DualPose(const Pose& pose) {
        Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
        if (q.w() < 0) q.coeffs() = -q.coeffs();
        const Vec3 t = 0.5 * pose.translation();
        real = q.coeffs();
        dual = (Eigen::Quaterniond(0, t.x(), t.y(), t.z()) * q).coeffs();
    }

    /// A rotation is two quaternions, one for either way round: the one on the side of another, for a motion
    /// of more than half a turn.
    DualPose onSideOf(const Eigen::Vector4d& side) const {
        DualPose result = *this;
        if (side.dot(real) < 0) result.real = -real, result.dual = -dual;
        return result;
    }
};

/// The mean of some motions, weighted by shares. What the shares leave to 1 stays where it is.
class PoseBlend {
public:
    PoseBlend() = default;
    /// asGiven: a motion goes the way round that its quaternion says, be it more than half a turn.
    explicit PoseBlend(bool asGiven) : asGiven_(asGiven) {}

    void add(double share, const DualPose& pose) {
        // A rotation is two quaternions: the one on the side of what is there already, at first of rest.
        const double side = asGiven_ ? 1 : real_.isZero() ? pose.real[3] : real_.dot(pose.real);
        const double signed_ = side < 0 ? -share : share;
        real_ += signed_ * pose.real;
        dual_ += signed_ * pose.dual;
        left_ -= share;
    }

    /// A mean that is no rotation (opposite ones in equal shares) is rest.
    Pose pose() const {
        Eigen::Vector4d real = real_;
        real[3] += real[3] < 0 && !asGiven_ ? -std::max(left_, 0.0) : std::max(left_, 0.0);
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
    bool asGiven_ = false;
};

/// Part of the way from one motion to another, round the side that is meant. A share of 0 is the first bit
/// for bit.
inline Pose blendBetween(const Pose& from, const Pose& to, double share,
                         const Eigen::Vector4d& side = {0, 0, 0, 1}) {
    if (share == 0 || from.matrix() == to.matrix()) return from;
    PoseBlend blend(true);
    blend.add(share, DualPose(from.inverse(Eigen::Isometry) * to).onSideOf(side));
    return from * blend.pose();
}

} // namespace tss
