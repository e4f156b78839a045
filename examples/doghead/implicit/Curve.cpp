#include "examples/doghead/implicit/Curve.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace doghead {

Profile::Profile(std::vector<Knot> knots) : knots_(std::move(knots)), slopes_(knots_.size()) {
    const std::size_t n = knots_.size();
    const auto chord = [&](std::size_t i) {
        return (knots_[i + 1].value - knots_[i].value) / (knots_[i + 1].at - knots_[i].at);
    };
    slopes_.front() = chord(0);
    slopes_.back() = chord(n - 2);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double before = chord(i - 1), after = chord(i);
        if (before * after <= 0) continue; // a turning point: level
        const double hBefore = knots_[i].at - knots_[i - 1].at, hAfter = knots_[i + 1].at - knots_[i].at;
        const double wBefore = 2 * hAfter + hBefore, wAfter = hAfter + 2 * hBefore;
        slopes_[i] = (wBefore + wAfter) / (wBefore / before + wAfter / after);
    }
}

double Profile::operator()(double at) const {
    if (at <= knots_.front().at) return knots_.front().value;
    if (at >= knots_.back().at) return knots_.back().value;
    std::size_t i = 0;
    while (at > knots_[i + 1].at) ++i;
    const double h = knots_[i + 1].at - knots_[i].at, t = (at - knots_[i].at) / h;
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * knots_[i].value + (t3 - 2 * t2 + t) * h * slopes_[i] +
           (3 * t2 - 2 * t3) * knots_[i + 1].value + (t3 - t2) * h * slopes_[i + 1];
}

double Profile::slope(double at) const {
    return ((*this)(at + 0.5) - (*this)(at - 0.5));
}

namespace {

using Row = Eigen::Matrix<double, 5, 1>; ///< x, y, z, across, along

/// The curve of a sweep: Catmull-Rom, the end tangents along the first and last chords.
class Spine {
public:
    Spine(const std::vector<Station>& stations, const Vec3& up, bool flat) : up_(up), flat_(flat) {
        for (const Station& s : stations) rows_.push_back((Row() << s.centre, s.across, s.along).finished());
        for (int i = 0; i <= spans() * coarse; ++i) polyline_.push_back(at(double(i) / coarse).head<3>());
    }

    int spans() const { return static_cast<int>(rows_.size()) - 1; }
    Row at(double u, Row* slope = nullptr) const;
    double distance(const Vec3& p) const;

private:
    static constexpr int coarse = 4;
    double nearest(const Vec3& p) const;

    std::vector<Row> rows_;
    std::vector<Vec3> polyline_;
    Vec3 up_;
    bool flat_; ///< parallel sides instead of an ellipse
};

Row Spine::at(double u, Row* slope) const {
    const int i = std::clamp(static_cast<int>(u), 0, spans() - 1);
    const double t = u - i;
    const Row &a = rows_[i], &b = rows_[i + 1];
    const Row before = i > 0 ? rows_[i - 1] : Row(2 * a - b),
              after = i + 1 < spans() ? rows_[i + 2] : Row(2 * b - a);
    const Row ta = (b - before) / 2, tb = (after - a) / 2;
    if (slope)
        *slope = (6 * t * t - 6 * t) * (a - b) + (3 * t * t - 4 * t + 1) * ta + (3 * t * t - 2 * t) * tb;
    Row r = (2 * t * t * t - 3 * t * t + 1) * a + (t * t * t - 2 * t * t + t) * ta +
            (3 * t * t - 2 * t * t * t) * b + (t * t * t - t * t) * tb;
    // The radii stay between those of the stations: a spline may swing below zero at a sharp taper.
    for (int k = 3; k < 5; ++k) r[k] = std::clamp(r[k], std::min(a[k], b[k]), std::max(a[k], b[k]));
    return r;
}

/// The parameter of the point of the curve nearest to p: the polyline's, then Newton steps, so that the solid
/// is as smooth as its curve.
double Spine::nearest(const Vec3& p) const {
    double u = 0, square = 1e300;
    for (std::size_t i = 0; i + 1 < polyline_.size(); ++i) {
        const Vec3 edge = polyline_[i + 1] - polyline_[i], offset = p - polyline_[i];
        const double t = std::clamp(offset.dot(edge) / edge.squaredNorm(), 0., 1.);
        const double d = (offset - t * edge).squaredNorm();
        if (d < square) square = d, u = (double(i) + t) / coarse;
    }
    for (int i = 0; i < 3; ++i) {
        Row slope;
        const Vec3 offset = p - at(u, &slope).head<3>(), tangent = slope.head<3>();
        u = std::clamp(u + std::clamp(offset.dot(tangent) / tangent.squaredNorm(), -0.1, 0.1), 0.,
                       double(spans()));
    }
    return u;
}

double Spine::distance(const Vec3& p) const {
    Row slope;
    const Row r = at(nearest(p), &slope);
    const Vec3 offset = p - r.head<3>();
    if (r[3] == r[4]) return offset.norm() - r[3];
    const Vec3 tangent = slope.head<3>().normalized();
    const Vec3 across = up_.cross(tangent).normalized(), along = tangent.cross(across);
    if (flat_) {
        const double beyond = std::max(0., std::abs(offset.dot(along)) - std::max(0., r[4] - r[3]));
        return Vec3(offset.dot(across), beyond, offset.dot(tangent)).norm() - r[3];
    }
    const double least = std::min(r[3], r[4]);
    const Vec3 scaled(offset.dot(across) / r[3], offset.dot(along) / r[4], offset.dot(tangent) / least);
    const double k0 = scaled.norm(), k1 = scaled.cwiseQuotient(Vec3(r[3], r[4], least)).norm();
    return k1 > 1e-9 ? k0 * (k0 - 1) / k1 : -least;
}

} // namespace

static Field swept(const std::vector<Station>& stations, const Vec3& up, bool flat) {
    const auto spine = std::make_shared<const Spine>(stations, up, flat);
    Box box;
    for (int i = 0; i <= 8 * spine->spans(); ++i) {
        const Row row = spine->at(i / 8.);
        const Vec3 centre = row.head<3>(), r = Vec3::Constant(std::max(row[3], row[4]));
        box.extend(Box(centre - r, centre + r));
    }
    return {[spine](const Vec3& p) { return spine->distance(p); }, box};
}

Field sweep(const std::vector<Station>& stations, const Vec3& up) {
    return swept(stations, up, false);
}

Field ribbon(const std::vector<Station>& stations, const Vec3& up) {
    return swept(stations, up, true);
}

Field tube(const std::vector<Vec3>& points, const std::vector<double>& radii) {
    std::vector<Station> stations;
    for (std::size_t i = 0; i < points.size(); ++i) stations.push_back({points[i], radii[i], radii[i]});
    return sweep(stations, Vec3::UnitZ());
}

Outline smoothOutline(const Outline& corners, int steps) {
    Outline fine;
    const std::size_t n = corners.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector2d &a = corners[i], &b = corners[(i + 1) % n];
        const Eigen::Vector2d ta = (b - corners[(i + n - 1) % n]) / 2, tb = (corners[(i + 2) % n] - a) / 2;
        for (int k = 0; k < steps; ++k) {
            const double t = double(k) / steps, t2 = t * t, t3 = t2 * t;
            fine.push_back((2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * ta + (3 * t2 - 2 * t3) * b +
                           (t3 - t2) * tb);
        }
    }
    return fine;
}

double outlineDistance(const Outline& polygon, const Eigen::Vector2d& p) {
    double square = 1e300;
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Eigen::Vector2d edge = polygon[j] - polygon[i], offset = p - polygon[i];
        const double t = std::clamp(offset.dot(edge) / edge.squaredNorm(), 0., 1.);
        square = std::min(square, (offset - t * edge).squaredNorm());
        const bool crosses = (polygon[i].y() > p.y()) != (polygon[j].y() > p.y());
        if (crosses && p.x() < polygon[i].x() + edge.x() * offset.y() / edge.y()) inside = !inside;
    }
    return (inside ? -1 : 1) * std::sqrt(square);
}

Field plate(const PlateShape& shape) {
    const auto outline = std::make_shared<const Outline>(smoothOutline(shape.outline, 6));
    // Distances across the tilted plate shrink by the cosine of its tilt.
    const double tilt = 1 / std::sqrt(1 + shape.slopeX * shape.slopeX + shape.slopeZ * shape.slopeZ);
    Box box;
    for (const Eigen::Vector2d& c : *outline) {
        const double y = shape.level + shape.slopeX * c.x() + shape.slopeZ * c.y();
        const Vec3 r = Vec3::Constant(shape.halfThickness / tilt);
        box.extend(Box(Vec3(c.x(), y, c.y()) - r, Vec3(c.x(), y, c.y()) + r));
    }
    const auto distance = [=](const Vec3& p) {
        const double middle = shape.level + shape.slopeX * p.x() + shape.slopeZ * p.z();
        const double rim = outlineDistance(*outline, {p.x(), p.z()}) + shape.halfThickness;
        const double face = std::abs(p.y() - middle) * tilt;
        if (rim <= 0) return face - shape.halfThickness;
        return std::hypot(rim, face) - shape.halfThickness;
    };
    return {distance, box};
}

} // namespace doghead
