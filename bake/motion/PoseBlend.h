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
    /// With w >= 0: a rotation of at most half a turn.
    explicit DualPose(const Pose& pose) {
        Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear()).normalized();
        if (q.w() < 0) q.coeffs() = -q.coeffs();
        const Vec3 t = 0.5 * pose.translation();
        real = q.coeffs();
        dual = (Eigen::Quaterniond(0, t.x(), t.y(), t.z()) * q).coeffs();
    }

    /// q and -q are the same rotation, reached by turning the one way or the other: the one of the two in the
    /// hemisphere of a reference quaternion, which may be a turn of more than half a turn.
    DualPose inHemisphereOf(const Eigen::Vector4d& reference) const {
        DualPose result = *this;
        if (reference.dot(real) < 0) result.real = -real, result.dual = -dual;
        return result;
    }
};

/// Dual quaternion linear blending (DLB): the mean of motions weighted by shares. Where the shares sum to
/// less than 1, the identity has the rest.
class PoseBlend {
public:
    PoseBlend() = default;
    /// keepSigns: quaternions are summed with the signs they have, so that a turn may be more than half a
    /// turn; otherwise each is first brought into the hemisphere of the sum so far.
    explicit PoseBlend(bool keepSigns) : keepSigns_(keepSigns) {}

    void add(double share, const DualPose& pose) {
        const double side = keepSigns_ ? 1 : real_.isZero() ? pose.real[3] : real_.dot(pose.real);
        const double signed_ = side < 0 ? -share : share;
        real_ += signed_ * pose.real;
        dual_ += signed_ * pose.dual;
        left_ -= share;
    }

    /// The normalised mean; the identity where it vanishes, as of opposite quaternions in equal shares.
    Pose pose() const {
        Eigen::Vector4d real = real_;
        real[3] += real[3] < 0 && !keepSigns_ ? -std::max(left_, 0.0) : std::max(left_, 0.0);
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
    bool keepSigns_ = false;
};

} // namespace tss
