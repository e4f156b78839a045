#include "bake/motion/MuscleDeformer.h"

#include "bake/base/Error.h"
#include "bake/base/Infinity.h"
#include "bake/geometry/ConnectedParts.h"
#include "bake/motion/MuscleVolume.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tss {
namespace {

/// Least local length that a contraction may reach, as a share of that at rest.
constexpr double leastStretch = 0.05;
/// A fibre point farther from the surface than this many times its diagonal is refused as a mistake.
constexpr double farthestFibre = 100;

/// The muscle itself, if its surface has a volume and can be queried; throws otherwise. A rigid one gets a
/// fibre and a form that mean nothing, and is turned inside out where its volume is negative.
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
    for (const Tri& t : mesh.triangles)
        if (t.minCoeff() < 0 || t.maxCoeff() >= count)
            throw InputError("the surface of a muscle has an index out of range");
    for (const Vec3& v : mesh.vertices)
        if (!v.allFinite()) throw InputError("the surface of a muscle has a vertex that is not finite");
    if (const double open = rigid ? 0 : openShare(mesh); open > mostOpenShare)
        throw InputError("the openings of a muscle's surface are " + std::to_string(std::lround(100 * open)) +
                         " % as large as it: it must be closed, or nearly, since its volume is to be kept");
    const Eigen::AlignedBox3d box = bounds(mesh);
    for (const Vec3& p : muscle.fibre)
        if (!rigid && p.allFinite() && box.exteriorDistance(p) > farthestFibre * box.diagonal().norm())
            throw InputError("the fibre of a muscle has a point farther from its surface than " +
                             std::to_string(int(farthestFibre)) + " times the size of that");
    if (rigid && enclosedVolume(mesh.vertices, mesh.triangles) < 0)
        for (Tri& t : muscle.surface.triangles) std::swap(t[1], t[2]); // inside out
    return muscle;
}

/// Throws for a shell that is inside out. One inside of another is a hollow, and is to be.
void checkShells(const TriangleMesh& mesh) {
    std::vector<TriangleMesh> shells = connectedParts(mesh);
    for (TriangleMesh& shell : shells) shell = closed(std::move(shell));
    for (const TriangleMesh& shell : shells) {
        if (!(enclosedVolume(shell.vertices, shell.triangles) < 0)) continue;
        const Eigen::AlignedBox3d box = bounds(shell);
        const bool hollow = std::any_of(shells.begin(), shells.end(), [&](const TriangleMesh& other) {
            return enclosedVolume(other.vertices, other.triangles) > 0 && bounds(other).contains(box);
        });
        const Vec3 at = box.center();
        if (!hollow)
            throw InputError("the surface of a muscle has " + std::to_string(shells.size()) +
                             " shells, and that about (" + std::to_string(at.x()) + ", " +
                             std::to_string(at.y()) + ", " + std::to_string(at.z()) + ") is inside out");
    }
}

} // namespace

MuscleDeformer::MuscleDeformer(Muscle muscle)
    : muscle_(checked(std::move(muscle))),
      ring_(muscle_.form == MuscleForm::Ring ? std::optional<MuscleRing>(muscle_.fibre) : std::nullopt),
      fibre_(ring_ ? std::vector<Vec3>{Vec3::Zero(), Vec3::UnitX()} : muscle_.fibre),
      locator_(muscle_.surface), closed_(closed(muscle_.surface).triangles) {
    const TriangleMesh& mesh = muscle_.surface;
    volume_ = enclosedVolume(mesh.vertices, closed_);
    if (!enclosesVolume(mesh) && !rigid())
        throw InputError("the surface of a muscle is inside out or flat: its volume is not positive");
    if (!rigid()) checkShells(mesh);
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
    if (!muscle_.chainShares.empty() && muscle_.chainShares.size() != mesh.vertices.size())
        throw InputError("a muscle between two bones needs one share a vertex");

    normals_ = vertexNormals(mesh);
    const std::vector<Vec3> medial = muscle_.form == MuscleForm::Sheet && !rigid()
                                         ? medialOffsets(mesh, locator_, normals_)
                                         : std::vector<Vec3>();
    points_.reserve(mesh.vertices.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Vec3& x = mesh.vertices[v];
        const double s = parameter(x);
        const Vec3 offset = medial.empty() ? Vec3(x - linePoint(s)) : medial[v];
        shares_.push_back(!muscle_.chainShares.empty() ? muscle_.chainShares[v]
                          : ring_                      ? (1 - std::cos(2 * std::numbers::pi * s)) / 2
                                                       : contractionIntegral(s));
        points_.push_back({x, s, offset, normals_[v], 0, shares_.back()});
    }
    for (const double end : {lower, upper})
        if (ring_ && !isValidAt(end)) throwTooShort(end);
}

/// Of a ring: its volume is kept, and no vertex has passed its axis.
bool MuscleDeformer::isValidAt(double activation) const {
    constexpr double kept = 1e-6; // of the volume
    const std::vector<Vec3> now = vertices(activation);
    if (!(std::abs(enclosedVolume(now, closed_) - volume_) <= kept * volume_)) return false;
    for (std::size_t v = 0; v < now.size(); ++v)
        if (!(ring_->outward(now[v], points_[v].s) > 0)) return false;
    return true;
}

void MuscleDeformer::throwTooShort(double end) const {
    double works = 0, fails = 1; // of the contraction there
    for (int i = 0; i < 20; ++i) {
        const double middle = (works + fails) / 2;
        (isValidAt(middle * end) ? works : fails) = middle;
    }
    throw InputError("a ring of muscle may " + std::string(end < 0 ? "lengthen" : "shorten") +
                     " by at most " + std::to_string(works * std::abs(end) * muscle_.maxContraction) +
                     " of its length: beyond that it goes through its own middle or cannot keep its volume");
}

double MuscleDeformer::thickeningGain(double s, double activation) const {
    const double length = 1 - activation * muscle_.maxContraction * (ring_ ? 1 : contractionBump(s));
    return (muscle_.form == MuscleForm::Sheet ? 1 / length : 1 / std::sqrt(length)) - 1;
}

Vec3 MuscleDeformer::shiftAt(const MusclePoint& point, double activation) const {
    const double s = point.s;
    if (ring_) return -activation * muscle_.maxContraction * ring_->spoke(s);
    double shift = -activation * muscle_.maxContraction * (contractionIntegral(s) - anchorIntegral_);
    // Both ends of a muscle between two bones stay on them: the shift fades out towards either end.
    if (muscle_.spans) shift *= s > muscle_.anchor ? 1 - alongShare(point) : alongShare(point);
    return shift == 0 ? Vec3(Vec3::Zero()) : Vec3(fibre_.point(s + shift) - fibre_.point(s));
}

double MuscleDeformer::chainShare(const Vec3& rest) const {
    return bind(rest).share;
}

double MuscleDeformer::thickness(double s, const MuscleState& state) const {
    return 1 + state.thickening * thickeningGain(s, state.activation);
}

MuscleState MuscleDeformer::state(double activation) const {
    if (std::isnan(activation)) activation = 0;
    MuscleState state{std::clamp(activation, muscle_.activationLower, muscle_.activationUpper), 1};
    if (state.activation == 0) return state;

    // The vertices are p + k q. Next to activation 0 nothing thickens and any k will do.
    const Vec3 centre = points_.front().rest;
    std::vector<Vec3> p(points_.size()), q(points_.size());
    for (std::size_t v = 0; v < p.size(); ++v) {
        const MusclePoint& x = points_[v];
        p[v] = x.rest - centre + shiftAt(x, state.activation);
        q[v] = thickeningGain(x.s, state.activation) * x.offset;
    }
    state.thickening = swellingFor(volume_, swollenVolume(volume_, p, q, closed_), 1);
    return state;
}

std::vector<Vec3> MuscleDeformer::vertices(const MuscleState& state) const {
    std::vector<Vec3> result(points_.size());
    for (std::size_t v = 0; v < result.size(); ++v) result[v] = map(points_[v], state);
    return result;
}

Vec3 MuscleDeformer::map(const MusclePoint& point, const MuscleState& state) const {
    if (state.activation == 0) return point.rest;
    return point.rest + shiftAt(point, state.activation) +
           state.thickening * thickeningGain(point.s, state.activation) * point.offset;
}

MusclePoint MuscleDeformer::bind(const Vec3& rest) const {
    MusclePoint point{rest, parameter(rest), Vec3::Zero(), Vec3::Zero(), 0, 0};
    const NearestPoint near = locator_.nearest(rest, infinity);
    if (near.triangle < 0) return point;
    const Tri& t = muscle_.surface.triangles[near.triangle];
    Vec3 onSurface = Vec3::Zero();
    for (int k = 0; k < 3; ++k) {
        onSurface += near.weights[k] * points_[t[k]].offset;
        point.normal += near.weights[k] * normals_[t[k]];
        point.share += near.weights[k] * shares_[t[k]];
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
