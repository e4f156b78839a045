#include "bake/motion/MotionFrame.h"

#include "bake/base/Infinity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tss {

namespace {

/// The value moved ahead by 1e-9 of the path's range: one nearer than that before a row counts as on it, or
/// rounding could hold a joint just before a row for ever.
double nudged(const std::vector<PathRow>& rows, double value, double way) {
    return value + std::copysign(1e-9 * (rows.back().value - rows.front().value), way);
}

/// The two rows about a value, the segment ahead of it at a row.
const PathRow* segment(const std::vector<PathRow>& rows, double value, double way) {
    const auto first = rows.begin() + 1, last = rows.end() - 1;
    const auto next = way < 0 ? std::lower_bound(first, last, value,
                                                 [](const PathRow& row, double v) { return row.value < v; })
                              : std::upper_bound(first, last, value,
                                                 [](double v, const PathRow& row) { return v < row.value; });
    return &*(next - 1);
}

/// The turn from one row to the next as a rotation vector in the first row's own frame (the short way round,
/// at half a turn the one that slerp takes by the product of the two).
Vec3 turnOfRows(const PathRow& r0, const PathRow& r1) {
    Eigen::Quaterniond turn = r0.rotation.conjugate() * r1.rotation;
    if (r0.rotation.dot(r1.rotation) < 0) turn.coeffs() = -turn.coeffs();
    const double sine = turn.vec().norm();
    return sine > 0 ? Vec3(turn.vec() * (2 * std::atan2(sine, turn.w()) / sine)) : Vec3::Zero();
}

/// How a path moves on the segment that begins with a row. `where` is the DOF's own frame in A: the poses of
/// all DOFs before it; `own` its pose.
DofTwist pathTwist(const Dof& dof, const PathRow* rows, const Pose& where, const Pose& own) {
    DofTwist t;
    const double span = rows[1].value - rows[0].value;
    const Pose frame = where * dof.frame;
    t.turn = frame.linear() * (rows[0].rotation * turnOfRows(rows[0], rows[1])) / span;
    // The point of B that is at the path's origin moves with the rows' translation.
    const Vec3 moving = where * (own * (dof.frame * Vec3::Zero()));
    t.slide = frame.linear() * (rows[1].translation - rows[0].translation) / span - t.turn.cross(moving);
    return t;
}

DofTwist twist(const Dof& dof, const PathRow* rows, const Pose& where, const Pose& own) {
    DofTwist t;
    switch (dof.kind) {
    case DofKind::Rotation:
        t.turn = where.linear() * dof.axis;
        t.slide = (where * dof.origin).cross(t.turn);
        break;
    case DofKind::Translation:
        t.slide = where.linear() * dof.axis;
        break;
    case DofKind::Path:
        return pathTwist(dof, rows, where, own);
    }
    return t;
}

/// Largest slide and turn per unit over the segments within the limits.
void pathRates(const Dof& dof, double& slide, double& turn) {
    slide = turn = 0;
    for (std::size_t i = 0; i + 1 < dof.path.size(); ++i) {
        const PathRow &r0 = dof.path[i], &r1 = dof.path[i + 1];
        if (r1.value < dof.lower || r0.value > dof.upper) continue;
        const double span = r1.value - r0.value;
        slide = std::max(slide, (r1.translation - r0.translation).norm() / span);
        turn = std::max(turn, turnOfRows(r0, r1).norm() / span);
    }
}

} // namespace

void evaluateFrame(const Motion& motion, const double* q, const double* direction, MotionFrame& frame) {
    Pose before = Pose::Identity();
    frame.rowAhead = false;
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        const Pose own = dofPose(dof, q[k]);
        const PathRow *rows = nullptr, *still = nullptr;
        if (dof.kind == DofKind::Path) {
            rows = segment(dof.path, nudged(dof.path, q[k], direction[k]), direction[k]);
            still = segment(dof.path, q[k], direction[k]);
        }
        frame.twists[k] = twist(dof, rows, before, own);
        if (still != rows && !frame.rowAhead) {
            frame.rowAhead = true;
            std::copy_n(frame.twists.begin(), k, frame.twistsBeforeRow.begin());
        }
        if (frame.rowAhead)
            frame.twistsBeforeRow[k] = still != rows ? pathTwist(dof, still, before, own) : frame.twists[k];
        before = before * own;
    }
    frame.pose = before * motion.base;
}

void evaluateLinks(const Motion& motion, const double* q, std::size_t from, std::size_t to, Pose* before,
                   DofTwist* twists) {
    for (std::size_t k = from; k < to; ++k) {
        const Pose own = dofPose(motion.dofs[k], q[k]);
        twists[k] = twist(motion.dofs[k], nullptr, before[k], own);
        before[k + 1] = before[k] * own;
    }
}

void speedBounds(const Motion& motion, const Vec3& point, double* speeds) {
    // From the last DOF inwards: y is the point placed by the DOFs after k at the middle of their limits,
    // from where they may move it by at most `stray`.
    Vec3 y = motion.base * point;
    double stray = 0;
    for (std::size_t k = motion.dofs.size(); k-- > 0;) {
        const Dof& dof = motion.dofs[k];
        const double half = 0.5 * (dof.upper - dof.lower);
        const double middle = dof.lower + half;
        const Vec3 centre = dofPose(dof, middle) * y;
        switch (dof.kind) {
        case DofKind::Rotation:
            speeds[k] = (y - dof.origin).cross(dof.axis).norm() + stray;
            stray += 2 * speeds[k] * std::sin(0.5 * std::min(half, std::numbers::pi));
            break;
        case DofKind::Translation:
            speeds[k] = dof.axis.norm();
            stray += speeds[k] * half;
            break;
        case DofKind::Path: {
            double slide = 0, turn = 0;
            pathRates(dof, slide, turn);
            speeds[k] = slide + turn * ((dof.frame.inverse(Eigen::Isometry) * y).norm() + stray);
            stray += speeds[k] * half;
            break;
        }
        }
        // Room for the rounding of these sums themselves.
        speeds[k] *= 1 + 1e-12;
        y = centre;
    }
}

double turnBound(const Dof& dof) {
    if (dof.kind == DofKind::Rotation) return 1;
    if (dof.kind == DofKind::Translation) return 0;
    double slide = 0, turn = 0;
    pathRates(dof, slide, turn);
    return turn;
}

double nextRow(const Dof& dof, double q, double way) {
    const double none = std::copysign(infinity, way);
    if (dof.kind != DofKind::Path || way == 0) return none;
    q = nudged(dof.path, q, way);
    if (way > 0) {
        const auto row = std::upper_bound(dof.path.begin(), dof.path.end(), q,
                                          [](double v, const PathRow& r) { return v < r.value; });
        return row == dof.path.end() ? none : row->value;
    }
    const auto row = std::lower_bound(dof.path.begin(), dof.path.end(), q,
                                      [](const PathRow& r, double v) { return r.value < v; });
    return row == dof.path.begin() ? none : (row - 1)->value;
}

} // namespace tss
