#include "bake/motion/MuscleDeformer.h"

#include "bake/base/Error.h"
#include "bake/motion/MuscleMedial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace tss {
namespace {

/// Shortest local length, as a share of that at rest, that a muscle may be given.
constexpr double leastStretch = 0.05;

/// det of three columns, the six-fold volume of a tetrahedron at the origin.
double det(const Vec3& a, const Vec3& b, const Vec3& c) {
    return a.dot(b.cross(c));
}

/// The muscle again when its surface is one that a volume and queries can be had of.
Muscle checked(Muscle muscle) {
    const TriangleMesh& mesh = muscle.surface;
    const int count = static_cast<int>(mesh.vertices.size());
    const bool rigid = isRigid(muscle);
    if (mesh.empty() && !rigid) throw InputError("the surface of a muscle has no triangles");
    if (rigid) { // one shape, whatever is asked
        muscle.activationLower = muscle.activationUpper = muscle.maxContraction = 0;
        muscle.fibre = {Vec3::Zero(), Vec3::UnitX()};
        muscle.form = MuscleForm::Tube;
    }
    std::map<std::pair<int, int>, int> balance;
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (a < 0 || a >= count) throw InputError("the surface of a muscle has an index out of range");
            if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    for (const auto& [edge, sum] : balance)
        if (sum != 0 && !rigid)
            throw InputError("the surface of a muscle must be closed: its volume is to be kept");
    for (const Vec3& v : mesh.vertices)
        if (!v.allFinite()) throw InputError("the surface of a muscle has a vertex that is not finite");
    if (rigid && enclosedVolume(mesh.vertices, mesh.triangles) < 0)
        for (Tri& t : muscle.surface.triangles) std::swap(t[1], t[2]); // inside out
    return muscle;
}

/// Root of c0 + c1 k + c2 k^2 + c3 k^3 next to k = 1.
double rootNearOne(const double (&c)[4], double scale) {
    double k = 1;
    for (int i = 0; i < 30; ++i) {
        const double f = c[0] + k * (c[1] + k * (c[2] + k * c[3]));
        const double slope = c[1] + k * (2 * c[2] + k * 3 * c[3]);
        // Next to activation 0 nothing thickens and any k will do.
        if (!(std::abs(slope) > 1e-9 * scale)) return 1;
        const double step = std::clamp(f / slope, -0.5, 0.5);
        k -= step;
        if (std::abs(step) <= 1e-15 * std::abs(k)) break;
    }
    return k;
}

} // namespace

double enclosedVolume(const std::vector<Vec3>& vertices, const std::vector<Tri>& triangles) {
    if (vertices.empty()) return 0;
    const Vec3& o = vertices.front();
    double sum = 0;
    for (const Tri& t : triangles) sum += det(vertices[t[0]] - o, vertices[t[1]] - o, vertices[t[2]] - o);
    return sum / 6;
}

MuscleDeformer::MuscleDeformer(Muscle muscle)
    : muscle_(checked(std::move(muscle))),
      ring_(muscle_.form == MuscleForm::Ring ? std::optional<MuscleRing>(muscle_.fibre) : std::nullopt),
      fibre_(ring_ ? std::vector<Vec3>{Vec3::Zero(), Vec3::UnitX()} : muscle_.fibre),
      locator_(muscle_.surface) {
    const TriangleMesh& mesh = muscle_.surface;
    volume_ = enclosedVolume(mesh.vertices, mesh.triangles);
    if (!(volume_ > 0) && !rigid())
        throw InputError("the surface of a muscle is inside out or flat: its volume is not positive");
    const double lower = muscle_.activationLower, upper = muscle_.activationUpper;
    if (!(std::isfinite(lower) && std::isfinite(upper) && lower <= upper))
        throw InputError("the activation range of a muscle must be finite and rising");
    if (!(std::isfinite(muscle_.maxContraction) && std::isfinite(muscle_.anchor)))
        throw InputError("contraction and anchor of a muscle must be finite");
    const double most = std::max(lower * muscle_.maxContraction, upper * muscle_.maxContraction);
    const double peak = ring_ ? 1 : contractionPeak();
    if (1 - most * peak < leastStretch)
        throw InputError("a muscle may shorten by at most " + std::to_string((1 - leastStretch) / peak) +
                         " of its " + (ring_ ? "length" : "chord") + " within its activation range");
    anchorIntegral_ = contractionIntegral(muscle_.anchor);

    normals_ = vertexNormals(mesh);
    const std::vector<Vec3> medial = muscle_.form == MuscleForm::Sheet && !rigid()
                                         ? medialOffsets(mesh, locator_, normals_)
                                         : std::vector<Vec3>();
    points_.reserve(mesh.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Vec3& x = mesh.vertices[v];
        const double s = parameter(x);
        const Vec3 offset = medial.empty() ? Vec3(x - linePoint(s)) : medial[v];
        points_.push_back({x, s, offset, normals_[v], 0});
    }
}

double MuscleDeformer::gain(double s, double activation) const {
    const double length = 1 - activation * muscle_.maxContraction * (ring_ ? 1 : contractionBump(s));
    return (muscle_.form == MuscleForm::Sheet ? 1 / length : 1 / std::sqrt(length)) - 1;
}

Vec3 MuscleDeformer::slide(double s, double activation) const {
    if (ring_) return -activation * muscle_.maxContraction * ring_->spoke(s);
    const double shift = -activation * muscle_.maxContraction * (contractionIntegral(s) - anchorIntegral_);
    return shift == 0 ? Vec3(Vec3::Zero()) : Vec3(fibre_.point(s + shift) - fibre_.point(s));
}

double MuscleDeformer::thickness(double s, const MuscleState& state) const {
    return 1 + state.thickening * gain(s, state.activation);
}

MuscleState MuscleDeformer::state(double activation) const {
    if (std::isnan(activation)) activation = 0;
    MuscleState state{std::clamp(activation, muscle_.activationLower, muscle_.activationUpper), 1};
    if (state.activation == 0) return state;

    // The vertices are p + k q, so the volume is a cubic in k.
    const Vec3 centre = points_.front().rest;
    std::vector<Vec3> p(points_.size()), q(points_.size());
    for (std::size_t v = 0; v < p.size(); ++v) {
        const MusclePoint& x = points_[v];
        p[v] = x.rest - centre + slide(x.s, state.activation);
        q[v] = gain(x.s, state.activation) * x.offset;
    }
    double c[4] = {-6 * volume_, 0, 0, 0};
    for (const Tri& t : muscle_.surface.triangles) {
        const Vec3 &p0 = p[t[0]], &p1 = p[t[1]], &p2 = p[t[2]], &q0 = q[t[0]], &q1 = q[t[1]], &q2 = q[t[2]];
        const Vec3 p01 = p0.cross(p1), q01 = q0.cross(q1), mixed = p0.cross(q1) + q0.cross(p1);
        c[0] += p01.dot(p2);
        c[1] += p01.dot(q2) + mixed.dot(p2);
        c[2] += mixed.dot(q2) + q01.dot(p2);
        c[3] += q01.dot(q2);
    }
    state.thickening = rootNearOne(c, volume_);
    return state;
}

std::vector<Vec3> MuscleDeformer::vertices(const MuscleState& state) const {
    std::vector<Vec3> result(points_.size());
    for (std::size_t v = 0; v < result.size(); ++v) result[v] = map(points_[v], state);
    return result;
}

Vec3 MuscleDeformer::map(const MusclePoint& point, const MuscleState& state) const {
    if (state.activation == 0) return point.rest;
    return point.rest + slide(point.s, state.activation) +
           state.thickening * gain(point.s, state.activation) * point.offset;
}

MusclePoint MuscleDeformer::bind(const Vec3& rest) const {
    MusclePoint point{rest, parameter(rest), Vec3::Zero(), Vec3::Zero(), 0};
    const NearestPoint near = locator_.nearest(rest, std::numeric_limits<double>::infinity());
    if (near.triangle < 0) return point;
    const Tri& t = muscle_.surface.triangles[near.triangle];
    Vec3 onSurface = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
        onSurface += near.weights[k] * points_[t[k]].offset;
        point.normal += near.weights[k] * normals_[t[k]];
    }
    point.normal.normalize();
    const bool outside = (rest - near.point).dot(point.normal) >= 0;
    point.height = outside ? near.distance : -near.distance;
    if (outside)
        point.offset = onSurface;
    else if (muscle_.form != MuscleForm::Sheet)
        point.offset = rest - linePoint(point.s);
    else if (const double half = onSurface.norm(); half > near.distance)
        point.offset = (1 - near.distance / half) * onSurface;
    return point;
}

} // namespace tss
