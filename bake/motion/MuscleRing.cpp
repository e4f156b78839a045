#include "bake/motion/MuscleRing.h"

#include "bake/base/Error.h"

#include <cmath>
#include <numbers>

namespace tss {

MuscleRing::MuscleRing(const std::vector<Vec3>& points) {
    constexpr double turn = 2 * std::numbers::pi;
    if (points.size() < 3) throw InputError("the fibre of a ring of muscle needs at least 3 points");
    for (const Vec3& p : points)
        if (!p.allFinite()) throw InputError("the fibre of a muscle has a point that is not finite");
    // The middle of the line, and the plane of the most area that it encloses.
    Vec3 middle = Vec3::Zero(), area = Vec3::Zero();
    double length = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec3 &a = points[i], &b = points[(i + 1) % points.size()];
        const double edge = (b - a).norm();
        middle += edge * ((a - points[0]) + (b - points[0])) / 2;
        length += edge;
        area += (a - points[0]).cross(b - points[0]);
    }
    if (!(length > 0) || !(area.norm() > 1e-6 * length * length))
        throw InputError("the fibre of a ring of muscle encloses no area");
    middle_ = points[0] + middle / length;
    axis_ = area.normalized();
    const Vec3 first = points[0] - middle_;
    x_ = (first - axis_.dot(first) * axis_).normalized();
    y_ = axis_.cross(x_);

    for (const Vec3& p : points) {
        const Vec3 from = p - middle_;
        double s = knots_.empty() ? 0 : std::atan2(y_.dot(from), x_.dot(from)) / turn;
        if (s < 0) s += 1;
        const double height = axis_.dot(from);
        if (!knots_.empty() && !(s > knots_.back().s))
            throw InputError("the fibre of a ring of muscle must go round its middle once, always on");
        knots_.push_back({s, (from - height * axis_).norm(), height, 0, 0});
    }
    if (!(knots_.back().s < 1)) throw InputError("the fibre of a ring of muscle names its first point twice");
    const std::size_t count = knots_.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Knot &before = knots_[(i + count - 1) % count], &after = knots_[(i + 1) % count];
        const double width = after.s - before.s + (i == 0 || i + 1 == count ? 1 : 0);
        knots_[i].radiusSlope = (after.radius - before.radius) / width;
        knots_[i].heightSlope = (after.height - before.height) / width;
    }
    knots_.push_back(knots_.front());
    knots_.back().s = 1;
}

double MuscleRing::parameter(const Vec3& x) const {
    const Vec3 from = x - middle_;
    const double s = std::atan2(y_.dot(from), x_.dot(from)) / (2 * std::numbers::pi);
    return s < 0 ? s + 1 : s;
}

MuscleRing::Place MuscleRing::place(double s) const {
    s -= std::floor(s);
    std::size_t i = 1;
    while (i + 1 < knots_.size() && knots_[i].s < s) ++i;
    const Knot &l = knots_[i - 1], &r = knots_[i];
    const double width = r.s - l.s, t = (s - l.s) / width, u = 1 - t;
    const auto between = [&](double a, double b, double slopeA, double slopeB) {
        return u * u * (1 + 2 * t) * a + t * t * (1 + 2 * u) * b + width * t * u * (u * slopeA - t * slopeB);
    };
    return {between(l.radius, r.radius, l.radiusSlope, r.radiusSlope),
            between(l.height, r.height, l.heightSlope, r.heightSlope)};
}

Vec3 MuscleRing::along(double s) const {
    const double angle = 2 * std::numbers::pi * s;
    return std::cos(angle) * x_ + std::sin(angle) * y_;
}

Vec3 MuscleRing::spoke(double s) const {
    return place(s).radius * along(s);
}

Vec3 MuscleRing::point(double s) const {
    const Place at = place(s);
    return middle_ + at.radius * along(s) + at.height * axis_;
}

} // namespace tss
