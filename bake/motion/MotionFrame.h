#pragma once
#include "bake/motion/Motion.h"

namespace tss {

/// How one DOF moves a point x of A's frame, per unit of its value: x' = turn x x + slide.
struct DofTwist {
    Vec3 turn = Vec3::Zero();
    Vec3 slide = Vec3::Zero();
    Vec3 velocity(const Vec3& x) const { return turn.cross(x) + slide; }
};

/// Where body B stands, and how each DOF of the motion would move it from there.
struct MotionFrame {
    Pose pose = Pose::Identity();
    std::array<DofTwist, maxDofs> twists;
    /// Set only where rowAhead: the twists on the last bit of the way before the row; equal to `twists` for
    /// DOFs that are not at a row.
    std::array<DofTwist, maxDofs> twistsBeforeRow;
    /// Some path DOF is within rounding before one of its rows; `twists` are those beyond the row.
    bool rowAhead = false;
};

/// T(q), the same bits as pose(motion, q), and the twists there. q, direction: one value per DOF of the
/// motion; at a row of a path, and up to 1e-9 of its values before it, the segment that lies beyond it in
/// `direction` is meant.
void evaluateFrame(const Motion& motion, const double* q, const double* direction, MotionFrame& frame);

/// Part of evaluateFrame(), for a motion without paths, with the same bits. before[k] is the product of the
/// poses of all DOFs before k: given for k <= from, computed for from < k <= to; twists[k] is computed for
/// from <= k < to. T(q) = before[#DOFs] * motion.base.
void evaluateLinks(const Motion& motion, const double* q, std::size_t from, std::size_t to, Pose* before,
                   DofTwist* twists);

/// How fast a point of B can move anywhere in the limits: speed per unit of each DOF's value (the lever of a
/// turn, METHOD 2.2), found from the last DOF inwards. point: in B's frame. speeds: one per DOF.
void speedBounds(const Motion& motion, const Vec3& point, double* speeds);

/// The most that a DOF turns per unit of its value: 1, 0 for a translation.
double turnBound(const Dof& dof);

/// The value of the next row of the path strictly beyond q in the direction of `way`; infinity with its sign
/// where there is none, or for a DOF that is no path.
double nextRow(const Dof& dof, double q, double way);

} // namespace tss
