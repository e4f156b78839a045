#pragma once
#include "bake/motion/Motion.h"

namespace tss {

/// A box of DOF values, one cell of Q: lower[k] <= q[k] <= upper[k], k < #DOFs.
struct Cell {
    std::array<double, maxDofs> lower{}, upper{};
};

/// The box of all limits. Throws InputError for more than maxDofs DOFs.
Cell wholeBox(const Motion& motion);

/// What bounds need to know about a motion, worked out once: the rates of each path's segments.
class MotionRates {
public:
    explicit MotionRates(const Motion& motion);

    struct Segment {
        double from, to; ///< values at its ends
        Vec3 turn;       ///< rotation vector per unit of value, in the path's frame
        Vec3 slide;      ///< translation per unit of value, in the path's frame
    };

    const Motion& motion() const { return *motion_; }
    const std::vector<Segment>& segments(std::size_t dof) const { return segments_[dof]; }

    /// A value strictly inside the cell's range of this DOF to cut it at: the knot of a path nearest to the
    /// middle where there is one, for motion is smooth between knots only; else the middle.
    double cut(std::size_t dof, double lower, double upper) const;

private:
    const Motion* motion_;
    std::vector<std::vector<Segment>> segments_; ///< per DOF; empty unless it is a path
};

/// By how much rounding may move T(q)y, or what CellMotion says of its moves, for points y within inB of B's
/// origin and points of A within inA of A's: a bound on the error of their distance, and of move and
/// remainder where these are no more than that distance. Whatever is dropped as too far apart has to be
/// farther than it need be by this. Scene units.
double coordinateRounding(const Motion& motion, double inA, double inB);

/// How points of B move while q stays in one cell (METHOD 2.2 and 3.3). Exact mathematics in double: rounding
/// is not included, coordinateRounding() bounds it.
class CellMotion {
public:
    CellMotion(const MotionRates& rates, const Cell& cell);

    std::size_t dofs() const { return dofs_; }
    const Pose& centrePose() const { return pose_; }           ///< T(q0), q0 the cell's centre
    double half(std::size_t k) const { return axes_[k].half; } ///< half width h of DOF k
    std::span<const double> centre() const { return {centre_.data(), dofs_}; } ///< q0

    struct PointMotion {
        double move;      ///< |T(q)y - x| is at most this for every q of the cell, x = T(q0)y
        double remainder; ///< |T(q)y - x - J(q - q0)| is at most this, J the Jacobian at q0
    };
    PointMotion pointMotion(const Vec3& x) const;

    /// The part of pointMotion(x).move that each DOF adds: which one to split.
    std::array<double, maxDofs> shares(const Vec3& x) const;

    /// v . J: how the product of x(q) with a fixed vector v changes with each DOF, at q0.
    void slope(const Vec3& x, const Vec3& v, double* out) const {
        for (std::size_t k = 0; k < dofs_; ++k)
            out[k] = axes_[k].turn.dot((x - axes_[k].origin).cross(v)) + axes_[k].slide.dot(v);
    }

    /// Two points of B at a distance of 1 move apart (as vectors) by no more than this, and by no more than
    /// the second away from what their Jacobians say. Both scale with the distance.
    double relativeMove() const { return relativeMove_; }
    /// The part of relativeMove() that DOF k adds.
    double relativeShare(std::size_t k) const { return axes_[k].chord; }
    double relativeRemainder() const { return relativeRemainder_; }

private:
    /// Without values of its own: most of maxDofs are not used, and cells are many.
    struct Axis {
        Vec3 turn;          ///< angular rate vector at q0, in A's frame
        Vec3 slide;         ///< linear rate at q0
        Vec3 origin;        ///< a point on the axis, or the centre of turning
        double half;        ///< half width of the cell
        double outerTurn;   ///< sum of turnRate half over the DOFs nearer to A
        double turnRate;    ///< largest |turn| in the cell
        double slideRate;   ///< largest |slide| in the cell
        double chord;       ///< 2 sin(turnRate half / 2), at most 2
        double turnChange;  ///< largest |turn - turn at q0| across knots
        double slideChange; ///< largest |slide - slide at q0| across knots
        bool aboutPoint;    ///< distances are to the origin, not to the axis
    };

    void addPath(const Dof& dof, const std::vector<MotionRates::Segment>& segments, const Pose& prefix,
                 const Cell& cell, std::size_t k);
    double distance(const Axis& axis, const Vec3& x) const;

    std::size_t dofs_;
    std::array<double, maxDofs> centre_; ///< #dofs_
    std::array<Axis, maxDofs> axes_;     ///< #dofs_
    Pose pose_;
    double relativeMove_ = 0, relativeRemainder_ = 0;
};

} // namespace tss
