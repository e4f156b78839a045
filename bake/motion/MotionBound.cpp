#include "bake/motion/MotionBound.h"

#include "bake/base/Error.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tss {

Cell wholeBox(const Motion& motion) {
    if (motion.dofCount() > maxDofs)
        throw InputError("motion: expected at most " + std::to_string(maxDofs) + " DOFs, found " +
                         std::to_string(motion.dofCount()));
    Cell cell;
    for (std::size_t k = 0; k < motion.dofCount(); ++k) {
        cell.lower[k] = motion.dofs[k].lower;
        cell.upper[k] = motion.dofs[k].upper;
    }
    return cell;
}

double coordinateRounding(const Motion& motion, double inA, double inB) {
    // No coordinate met on the way from B's frame to A's exceeds this by much.
    double size = inA + inB + motion.base.translation().norm(), offAxis = 0, maps = 1;
    for (const Dof& dof : motion.dofs) {
        size += dof.origin.norm() + dof.frame.translation().norm();
        maps += dof.kind == DofKind::Path ? 3 : 1; // frame, row, frame back
        if (dof.kind == DofKind::Rotation) offAxis += std::abs(dof.axis.norm() - 1);
        if (dof.kind == DofKind::Translation)
            size += dof.axis.norm() * std::max(std::abs(dof.lower), std::abs(dof.upper));
        double farthest = 0;
        for (const PathRow& row : dof.path) farthest = std::max(farthest, row.translation.norm());
        size += farthest;
    }
    // A map and its product with the others round a coordinate by some ten times 2^-53 of the size. An axis
    // that is not quite of unit length stretches what it turns.
    return (0x1p-49 * maps + 8 * offAxis) * size;
}

MotionRates::MotionRates(const Motion& motion) : motion_(&motion), segments_(motion.dofCount()) {
    for (std::size_t k = 0; k < motion.dofCount(); ++k) {
        const auto& rows = motion.dofs[k].path;
        if (motion.dofs[k].kind != DofKind::Path) continue;
        for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
            const double width = rows[i + 1].value - rows[i].value;
            Eigen::Quaterniond turn = rows[i + 1].rotation * rows[i].rotation.conjugate();
            // The shorter way round, at half a turn the one that slerp takes by this product.
            if (rows[i].rotation.dot(rows[i + 1].rotation) < 0) turn.coeffs() = -turn.coeffs();
            const double sine = turn.vec().norm(), angle = 2 * std::atan2(sine, turn.w());
            const Vec3 axis = sine > 0 ? Vec3(turn.vec() / sine) : Vec3::Zero();
            segments_[k].push_back({rows[i].value, rows[i + 1].value, axis * (angle / width),
                                    (rows[i + 1].translation - rows[i].translation) / width});
        }
    }
}

double MotionRates::cut(std::size_t dof, double lower, double upper) const {
    const double middle = lower + 0.5 * (upper - lower);
    double best = middle, distance = 0.49 * (upper - lower);
    for (const Segment& s : segments_[dof])
        if (std::abs(s.from - middle) < distance) {
            distance = std::abs(s.from - middle);
            best = s.from;
        }
    return best;
}

CellMotion::CellMotion(const MotionRates& rates, const Cell& cell) : dofs_(rates.motion().dofCount()) {
    const Motion& motion = rates.motion();
    Pose prefix = Pose::Identity();
    double turned = 0, knots = 0;
    for (std::size_t k = 0; k < dofs_; ++k) {
        const Dof& dof = motion.dofs[k];
        Axis& axis = axes_[k];
        centre_[k] = cell.lower[k] + 0.5 * (cell.upper[k] - cell.lower[k]);
        // Measured from the rounded centre, so that the cell is covered to the last bit.
        const double half = std::max(cell.upper[k] - centre_[k], centre_[k] - cell.lower[k]);
        axis = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), half, turned, 0, 0, 0, 0, 0, false};
        switch (dof.kind) {
        case DofKind::Rotation:
            axis.turn = prefix.linear() * dof.axis;
            axis.origin = prefix * dof.origin;
            axis.turnRate = 1;
            break;
        case DofKind::Translation:
            axis.slide = prefix.linear() * dof.axis;
            axis.slideRate = dof.axis.norm();
            break;
        case DofKind::Path:
            addPath(dof, rates.segments(k), prefix, cell, k);
            break;
        }
        const double angle = axis.turnRate * axis.half;
        axis.chord = 2 * std::sin(0.5 * std::min(angle, std::numbers::pi));
        turned += angle;
        relativeMove_ += axis.chord;
        knots += axis.half * axis.turnChange;
        prefix = prefix * dofPose(dof, centre_[k]);
    }
    relativeMove_ = std::min(relativeMove_, 2.0);
    relativeRemainder_ = 0.5 * turned * turned + knots;
    pose_ = prefix * motion.base;
}

void CellMotion::addPath(const Dof& dof, const std::vector<MotionRates::Segment>& segments,
                         const Pose& prefix, const Cell& cell, std::size_t k) {
    Axis& axis = axes_[k];
    const Pose frame = prefix * dof.frame;
    const double q0 = centre_[k];
    const auto at = std::find_if(segments.begin(), segments.end() - 1,
                                 [&](const MotionRates::Segment& s) { return q0 <= s.to; });
    for (const auto& s : segments) {
        if (s.to < cell.lower[k] || s.from > cell.upper[k]) continue;
        axis.turnRate = std::max(axis.turnRate, s.turn.norm());
        axis.slideRate = std::max(axis.slideRate, s.slide.norm());
        axis.turnChange = std::max(axis.turnChange, (s.turn - at->turn).norm());
        axis.slideChange = std::max(axis.slideChange, (s.slide - at->slide).norm());
    }
    axis.aboutPoint = axis.turnChange > 0;
    axis.turn = frame.linear() * at->turn;
    axis.slide = frame.linear() * at->slide;
    // The point that the path turns about moves with it: where the frame's origin is at q0.
    axis.origin = prefix * (dofPose(dof, q0) * dof.frame.translation());
}

double CellMotion::distance(const Axis& axis, const Vec3& x) const {
    if (axis.turnRate == 0) return 0;
    const Vec3 from = x - axis.origin;
    if (axis.aboutPoint) return from.norm();
    return axis.turn.cross(from).norm() / axis.turnRate;
}

CellMotion::PointMotion CellMotion::pointMotion(const Vec3& x) const {
    double move = 0, second = 0, knots = 0;
    for (std::size_t k = dofs_; k-- > 0;) {
        const Axis& axis = axes_[k];
        const double lever = distance(axis, x) + move;
        const double speed = axis.turnRate * lever + axis.slideRate;
        const double angle = axis.turnRate * axis.half;
        second += angle * angle * lever + 2 * axis.half * speed * axis.outerTurn;
        knots += axis.half * (axis.turnChange * lever + axis.slideChange);
        move += axis.chord * lever + axis.slideRate * axis.half;
    }
    return {move, 0.5 * second + knots};
}

std::array<double, maxDofs> CellMotion::shares(const Vec3& x) const {
    std::array<double, maxDofs> share{};
    double move = 0;
    for (std::size_t k = dofs_; k-- > 0;) {
        const Axis& axis = axes_[k];
        share[k] = axis.chord * (distance(axis, x) + move) + axis.slideRate * axis.half;
        move += share[k];
    }
    return share;
}

} // namespace tss
