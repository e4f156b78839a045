#include "bake/verify/PoseBox.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tss::verify {

namespace {

/// Sums and products of bounds are themselves rounded; a relative hair, far above their error, keeps them
/// bounds.
constexpr double outward = 1 + 1e-12;

} // namespace

std::array<Box, 2> Box::halves(std::size_t k, double at) const {
    std::array<Box, 2> both{*this, *this};
    both[0].upper[k] = both[1].lower[k] = at;
    return both;
}

Box limitsOf(const Motion& motion) {
    Box box;
    for (const Dof& dof : motion.dofs) {
        box.lower.push_back(dof.lower);
        box.upper.push_back(dof.upper);
    }
    return box;
}

std::vector<std::vector<double>> spreadOverLimits(const Motion& motion, int count, double onLimits) {
    std::vector<std::vector<double>> poses;
    std::vector<double> share(motion.dofCount(), 0.5);
    for (int n = 0; n < count; ++n) {
        std::vector<double>& q = poses.emplace_back();
        for (std::size_t k = 0; k < share.size(); ++k) {
            share[k] = std::fmod(share[k] + 1 / std::sqrt(double(k) + 2.3), 1.0);
            const double wide = std::clamp((1 + 2 * onLimits) * share[k] - onLimits, 0.0, 1.0);
            const Dof& dof = motion.dofs[k];
            q.push_back(std::clamp(dof.lower + wide * (dof.upper - dof.lower), dof.lower, dof.upper));
        }
    }
    return poses;
}

bool meetsPlanes(const Motion& motion, const Box& box) {
    for (const LimitPlane& plane : motion.planes) {
        double least = 0, size = std::abs(plane.bound);
        for (std::size_t k = 0; k < box.lower.size(); ++k) {
            const double c = plane.coefficients[k];
            least += std::min(c * box.lower[k], c * box.upper[k]);
            size += std::abs(c) * std::max(std::abs(box.lower[k]), std::abs(box.upper[k]));
        }
        if (least > plane.bound + 1e-13 * size) return false;
    }
    return true;
}

double coordinateBound(const Motion& motion, double reach) {
    double bound = reach + motion.base.translation().norm();
    for (const Dof& dof : motion.dofs) {
        switch (dof.kind) {
        case DofKind::Rotation:
            bound += 2 * dof.origin.norm();
            break;
        case DofKind::Translation:
            bound += dof.axis.norm() * std::max(std::abs(dof.lower), std::abs(dof.upper));
            break;
        case DofKind::Path: {
            double far = 0;
            for (const PathRow& row : dof.path) far = std::max(far, row.translation.norm());
            bound += 2 * dof.frame.translation().norm() + far;
            break;
        }
        }
    }
    return bound * outward;
}

PoseBox::PoseBox(const Motion& motion, const Box& box, double size) : base_(motion.base) {
    // Each link is a rotation made from sines and cosines and a handful of products and sums of numbers <=
    // size: 64 units of rounding a link are several times what they can add up to.
    error_ = 64 * double(motion.dofCount() + 2) * 0x1p-53 * size;
    // Axes and quaternions may be off unit length by what checkMotion() grants.
    for (const Dof& dof : motion.dofs) {
        if (dof.kind == DofKind::Rotation) error_ += 4 * std::abs(dof.axis.norm() - 1) * size;
        double off = 0;
        for (const PathRow& row : dof.path) off = std::max(off, std::abs(row.rotation.norm() - 1));
        error_ += 8 * off * size;
    }
    double outer = 0;
    pose_ = Pose::Identity();
    for (std::size_t k = 0; k < motion.dofCount(); ++k) {
        middle_.push_back(box.middle(k));
        links_.push_back(makeLink(motion.dofs[k], box.lower[k], box.upper[k], middle_[k]));
        Link& link = links_.back();
        const double angle = link.spinRate * link.half;
        link.chord = 2 * std::sin(std::min(angle, std::numbers::pi) / 2);
        turn_ += link.chord * outward;
        turnBend_ += 0.5 * angle * angle + angle * outer;
        if (link.bent) turnBend_ = std::numeric_limits<double>::infinity();
        outer += angle;
        spins_[k] = pose_.linear() * link.spin;
        pose_ = pose_ * link.pose;
    }
    pose_ = pose_ * base_;
    turn_ = std::min(turn_, 2.0) + 1e-14;
    turnBend_ = turnBend_ * outward + 1e-14;
}

PoseBox::Link PoseBox::makeLink(const Dof& dof, double lower, double upper, double middle) const {
    Link link;
    link.pose = dofPose(dof, middle);
    link.spin = link.slide = link.centre = Vec3::Zero();
    link.half = std::max(upper - middle, middle - lower) * outward;
    link.cut = middle;
    switch (dof.kind) {
    case DofKind::Rotation:
        link.spin = dof.axis;
        link.centre = dof.origin;
        link.spinRate = dof.axis.norm() * outward;
        break;
    case DofKind::Translation:
        link.slide = dof.axis;
        link.slideRate = dof.axis.norm() * outward;
        break;
    case DofKind::Path:
        addPath(link, dof, lower, upper, middle);
        break;
    }
    return link;
}

void PoseBox::addPath(Link& link, const Dof& dof, double lower, double upper, double middle) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < dof.path.size(); ++i) {
        const PathRow &from = dof.path[i], &to = dof.path[i + 1];
        // Those that only touch the box, as where it was cut at a knot, say nothing of it.
        if (lower < upper ? to.value <= lower || from.value >= upper : to.value < lower || from.value > upper)
            continue;
        const double width = to.value - from.value;
        // Twice the half angle between the two quaternions, the short way, at half a turn as slerp turns.
        Eigen::Quaterniond step = to.rotation * from.rotation.conjugate();
        if (from.rotation.dot(to.rotation) < 0) step.coeffs() = -step.coeffs();
        const double sine = step.vec().norm();
        const double angle = 2 * std::atan2(sine, step.w());
        const Vec3 axis = sine > 0 ? Vec3(step.vec() / sine) : Vec3::Zero();
        link.spinRate = std::max(link.spinRate, angle / width * outward);
        link.slideRate =
            std::max(link.slideRate, (to.translation - from.translation).norm() / width * outward);
        if (from.value > lower && from.value < upper && std::abs(from.value - middle) < nearest) {
            nearest = std::abs(from.value - middle);
            link.bent = true;
            link.cut = from.value;
        }
        if (middle >= from.value && middle <= to.value) {
            link.spin = dof.frame.linear() * axis * (angle / width);
            link.slide = dof.frame.linear() * (to.translation - from.translation) / width;
            link.centre = link.pose * dof.frame.translation();
        }
    }
}

MovingPoint PoseBox::carry(const Vec3& y, bool velocities) const {
    MovingPoint point;
    point.at = base_ * y;
    double bend = 0;
    for (std::size_t k = links_.size(); k-- > 0;) {
        const Link& link = links_[k];
        const double angle = link.spinRate * link.half;
        point.at = link.pose * point.at;
        const Vec3 arm = point.at - link.centre;
        // From the centre, or for a true axis from the axis.
        const double lever = (link.spinRate == 0 ? 0
                              : link.bent        ? arm.norm()
                                                 : link.spin.cross(arm).norm() / link.spinRate * outward) +
                             point.move + error_;
        // Inside this link nothing has turned yet: the bend so far is carried along, rotated. The new parts
        // are the curve of this link's own arc and the turning of what the inner links' motion adds.
        const double speed = link.spinRate * lever + link.slideRate;
        double inner = 0;
        if (velocities) {
            for (std::size_t l = k + 1; l < links_.size(); ++l) {
                point.velocity[l] = link.pose.linear() * point.velocity[l];
                inner += (point.velocity[l].norm() + error_) * links_[l].half;
            }
            point.velocity[k] = link.spin.cross(arm) + link.slide;
            bend = (bend * (1 + angle) + 0.5 * angle * angle * lever + angle * inner) * outward;
            if (link.bent) bend = std::numeric_limits<double>::infinity();
        }
        const double chord = link.chord * lever + link.slideRate * link.half;
        point.sweep[k] = std::min(chord, speed * link.half);
        point.move = (point.move + point.sweep[k]) * outward;
    }
    point.move += error_;
    point.bend = velocities ? bend + 4 * error_ : std::numeric_limits<double>::infinity();
    return point;
}

} // namespace tss::verify
