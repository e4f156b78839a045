#include "bake/motion/MuscleFibre.h"

#include "bake/base/Error.h"

#include <algorithm>

namespace tss {
namespace {

constexpr double ramp = 0.2; ///< share of the fibre over which the bump rises, and falls

/// Integral of the smooth step 3t^2 - 2t^3 from 0 to t.
double stepIntegral(double t) {
    return t * t * t * (1 - t / 2);
}

} // namespace

double contractionPeak() {
    return 1 / (1 - ramp);
}

double contractionBump(double s) {
    const double t = std::clamp(std::min(s, 1 - s) / ramp, 0.0, 1.0);
    return contractionPeak() * t * t * (3 - 2 * t);
}

double contractionIntegral(double s) {
    if (s > 0.5) return 1 - contractionIntegral(1 - s);
    if (s <= 0) return 0;
    return contractionPeak() * (s < ramp ? ramp * stepIntegral(s / ramp) : ramp / 2 + (s - ramp));
}

bool goesOnAlongChord(const std::vector<Vec3>& points) {
    const Vec3 chord = points.back() - points.front();
    for (std::size_t i = 1; i < points.size(); ++i)
        if (!(chord.dot(points[i] - points[i - 1]) > 0)) return false;
    return true;
}

MuscleFibre::MuscleFibre(const std::vector<Vec3>& points) {
    if (points.size() < 2) throw InputError("the fibre of a muscle needs at least 2 points");
    for (const Vec3& p : points)
        if (!p.allFinite()) throw InputError("the fibre of a muscle has a point that is not finite");
    origin_ = points.front();
    direction_ = points.back() - origin_;
    chord_ = direction_.norm();
    if (!(chord_ > 0)) throw InputError("origin and insertion of a muscle's fibre are the same point");
    direction_ /= chord_;

    knots_.push_back({0, Vec3::Zero(), Vec3::Zero()});
    for (std::size_t i = 1; i < points.size(); ++i) {
        const bool last = i + 1 == points.size();
        const double s = last ? 1 : parameter(points[i]);
        if (!last && (s <= knots_.back().s + 1e-6 || s >= 1 - 1e-6)) continue;
        const Vec3 side = points[i] - origin_ - s * chord_ * direction_;
        knots_.push_back({s, last ? Vec3(Vec3::Zero()) : side, Vec3::Zero()});
    }
    for (std::size_t i = 0; i < knots_.size(); ++i) {
        const Knot& before = knots_[i > 0 ? i - 1 : 0];
        const Knot& after = knots_[std::min(i + 1, knots_.size() - 1)];
        knots_[i].slope = (after.side - before.side) / (after.s - before.s);
    }
}

Vec3 MuscleFibre::point(double s) const {
    const Vec3 onChord = origin_ + s * chord_ * direction_;
    const Knot &first = knots_.front(), &last = knots_.back();
    if (s <= first.s) return onChord + (s - first.s) * first.slope;
    if (s >= last.s) return onChord + (s - last.s) * last.slope;
    std::size_t i = 1;
    while (knots_[i].s < s) ++i;
    const Knot &l = knots_[i - 1], &r = knots_[i];
    const double width = r.s - l.s, t = (s - l.s) / width, u = 1 - t;
    return onChord + u * u * (1 + 2 * t) * l.side + t * t * (1 + 2 * u) * r.side +
           width * t * u * (u * l.slope - t * r.slope);
}

} // namespace tss
