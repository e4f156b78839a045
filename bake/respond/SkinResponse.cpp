#include "bake/respond/SkinResponse.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Compliance of a contact as a share of its inverse mass. Contacts hardly fight each other, so less than the
/// sheet's floor will do, and the skin stays nearer to the surface.
constexpr double contactFloor = 0.002;
/// Change of a displacement, as a share of the skin's size, below which an unchanged input changes nothing.
constexpr double settledShare = 1e-9;
constexpr int pushRounds = 8; ///< of the faithful mode

double activationOf(std::span<const double> activations, const SkinMuscle& muscle, std::size_t m) {
    const double a = m < activations.size() ? activations[m] : 0;
    const std::vector<double>& nodes = muscle.surface.nodes;
    return std::isnan(a) || nodes.empty() ? 0 : std::clamp(a, nodes.front(), nodes.back());
}

} // namespace

SkinResponse::SkinResponse(std::shared_ptr<const SkinRig> rig)
    : rig_(std::move(rig)), displacements_(rig_->rest.size(), Vec3::Zero()), positions_(rig_->rest),
      normals_(rig_->restNormals), stretch_(rig_->edges.size(), 0), bend_(rig_->bends.size(), Vec3::Zero()),
      planes_(rig_->rows.size() + rig_->pokes.size()), lastActivations_(rig_->muscles.size(), 0),
      lastPoses_(rig_->muscles.size(), Pose::Identity()) {}

SkinUpdate SkinResponse::update(std::span<const double> activations, std::span<const Pose> poses) {
    bool same = true, rest = true;
    for (std::size_t m = 0; m < rig_->muscles.size(); ++m) {
        const double a = activationOf(activations, rig_->muscles[m], m);
        same = same && a == lastActivations_[m];
        rest = rest && a == 0;
        lastActivations_[m] = a;
        const Pose pose = m < poses.size() && poses[m].matrix().allFinite() ? poses[m] : Pose::Identity();
        same = same && pose.matrix() == lastPoses_[m].matrix();
        rest = rest && pose.matrix() == Pose::Identity().matrix();
        lastPoses_[m] = pose;
    }
    SkinUpdate result;
    result.rest = rest;
    if (rest) {
        result.moved = !atRest_;
        if (!atRest_) toRest();
        return result;
    }
    if (same && settled_) return result;
    atRest_ = false;
    result.moved = true;
    placeMuscles(*rig_, lastActivations_, lastPoses_, scene_);
    if (rig_->parameters.faithful)
        pushOut();
    else
        solve();
    finish();
    for (const Plane& p : planes_) result.contacts += p.multiplier > 0;
    return result;
}

void SkinResponse::toRest() {
    std::fill(displacements_.begin(), displacements_.end(), Vec3::Zero());
    std::fill(stretch_.begin(), stretch_.end(), 0.0);
    std::fill(bend_.begin(), bend_.end(), Vec3::Zero());
    std::fill(planes_.begin(), planes_.end(), Plane{});
    positions_ = rig_->rest;
    normals_ = rig_->restNormals;
    residual_ = 0;
    settled_ = atRest_ = true;
}

void SkinResponse::pushOut() {
    for (std::size_t r = 0; r < rig_->rows.size(); ++r) {
        const SkinRow& row = rig_->rows[r];
        Vec3 x = rig_->rest[row.vertex];
        for (int round = 0; round < pushRounds; ++round) {
            double deepest = 0;
            Vec3 push = Vec3::Zero();
            for (std::uint32_t k = row.first; k < row.last; ++k) {
                const SkinTest& test = rig_->tests[k];
                const PlacedMuscle& muscle = scene_.muscles[test.muscle];
                const Vec3 away = x - muscle.centres[test.sphere];
                const double distance = away.norm();
                const double depth = muscle.radii[test.sphere] + row.radius + test.restGap - distance;
                if (depth <= deepest) continue;
                deepest = depth;
                push = distance > 0 ? Vec3(depth / distance * away)
                                    : Vec3(depth * rig_->restNormals[row.vertex]);
            }
            if (deepest <= 0) break;
            x += push;
        }
        displacements_[row.vertex] = x - rig_->rest[row.vertex];
        planes_[r].multiplier = displacements_[row.vertex].norm();
    }
    settled_ = true;
    residual_ = 0;
}

void SkinResponse::solve() {
    findContacts();
    warmStart();
    const std::vector<Vec3> before = displacements_;
    for (int i = 0; i < rig_->parameters.iterations; ++i) sweep();
    settled_ = residual_ <= settledShare * rig_->size;
}

std::size_t SkinResponse::findContacts() {
    const std::size_t rows = rig_->rows.size();
    std::size_t found = 0;
    for (std::size_t i = 0; i < planes_.size(); ++i) {
        Plane& plane = planes_[i];
        plane.contact = i < rows ? rowContact(*rig_, scene_, i) : pokeContact(*rig_, scene_, i - rows);
        plane.bound = plane.contact.bound + (i < rows ? rig_->rowOffsets[i] : rig_->pokeOffsets[i - rows]);
        plane.mass = 0;
        for (int k = 0; k < 3; ++k)
            plane.mass += rig_->inverseMass[plane.contact.vertex[k]] * plane.contact.weight[k] *
                          plane.contact.weight[k];
        plane.compliance = contactFloor * plane.mass;
        // A push carried over to a normal that has turned away would cycle.
        if (!plane.contact.found() || !(plane.mass > 0) || plane.contact.normal.dot(plane.before) < 0.5)
            plane.multiplier = 0;
        plane.before = plane.contact.normal;
        found += plane.contact.found();
    }
    return found;
}

void SkinResponse::warmStart() {
    const std::vector<double>& w = rig_->inverseMass;
    std::vector<Vec3>& u = displacements_;
    std::fill(u.begin(), u.end(), Vec3::Zero());
    for (std::size_t e = 0; e < stretch_.size(); ++e) {
        const SkinEdge& edge = rig_->edges[e];
        u[edge.i] += stretch_[e] * edge.direction;
        u[edge.j] -= stretch_[e] * edge.direction;
    }
    for (std::size_t b = 0; b < bend_.size(); ++b) {
        const SkinBend& bend = rig_->bends[b];
        u[bend.centre] += bend_[b];
        const Vec3 part = bend_[b] / static_cast<double>(bend.last - bend.first);
        for (std::uint32_t k = bend.first; k < bend.last; ++k) u[rig_->ring[k]] -= part;
    }
    for (const Plane& p : planes_)
        if (p.multiplier > 0)
            for (int k = 0; k < 3; ++k)
                u[p.contact.vertex[k]] += p.multiplier * p.contact.weight[k] * p.contact.normal;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = scene_.reference[i] + w[i] * u[i];
}

void SkinResponse::sweep() {
    const std::vector<double>& w = rig_->inverseMass;
    std::vector<Vec3>& u = displacements_;
    residual_ = 0;
    for (std::size_t e = 0; e < stretch_.size(); ++e) {
        const SkinEdge& edge = rig_->edges[e];
        const double c = edge.direction.dot(u[edge.i] - u[edge.j]);
        const double step = -(c + edge.compliance * stretch_[e]) / (w[edge.i] + w[edge.j] + edge.compliance);
        stretch_[e] += step;
        u[edge.i] += w[edge.i] * step * edge.direction;
        u[edge.j] -= w[edge.j] * step * edge.direction;
        residual_ = std::max(residual_, std::abs(step) * std::max(w[edge.i], w[edge.j]));
    }
    for (std::size_t b = 0; b < bend_.size(); ++b) {
        const SkinBend& bend = rig_->bends[b];
        const double share = 1.0 / (bend.last - bend.first);
        Vec3 mean = Vec3::Zero();
        for (std::uint32_t k = bend.first; k < bend.last; ++k) mean += u[rig_->ring[k]];
        const Vec3 c = u[bend.centre] - share * mean;
        const Vec3 step = -(c + bend.compliance * bend_[b]) / (bend.weight + bend.compliance);
        bend_[b] += step;
        u[bend.centre] += w[bend.centre] * step;
        for (std::uint32_t k = bend.first; k < bend.last; ++k)
            u[rig_->ring[k]] -= w[rig_->ring[k]] * share * step;
        residual_ = std::max(residual_, w[bend.centre] * step.cwiseAbs().maxCoeff());
    }
    for (Plane& p : planes_) {
        if (!(p.mass > 0) || !p.contact.found()) continue;
        double c = -p.bound;
        for (int k = 0; k < 3; ++k) c += p.contact.weight[k] * p.contact.normal.dot(u[p.contact.vertex[k]]);
        const double next =
            std::max(0.0, p.multiplier - (c + p.compliance * p.multiplier) / (p.mass + p.compliance));
        const double step = next - p.multiplier;
        if (step == 0) continue;
        p.multiplier = next;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = p.contact.vertex[k];
            u[v] += w[v] * step * p.contact.weight[k] * p.contact.normal;
        }
        residual_ = std::max(residual_, std::abs(step) * p.mass);
    }
}

void SkinResponse::finish() {
    for (std::size_t i = 0; i < positions_.size(); ++i) positions_[i] = rig_->rest[i] + displacements_[i];
    std::fill(normals_.begin(), normals_.end(), Vec3::Zero());
    const int touched = static_cast<int>(positions_.size());
    const auto place = [&](int v) -> const Vec3& {
        return v < touched ? positions_[v] : rig_->border[v - touched];
    };
    for (const Tri& t : rig_->normalTriangles)
        for (int k = 0; k < 3; ++k) {
            if (t[k] >= touched) continue;
            const Vec3 u = place(t[(k + 1) % 3]) - place(t[k]), v = place(t[(k + 2) % 3]) - place(t[k]);
            const Vec3 cross = u.cross(v);
            const double length = cross.norm();
            if (length > 0) normals_[t[k]] += std::atan2(length, u.dot(v)) / length * cross;
        }
    for (Vec3& n : normals_)
        if (const double length = n.norm(); length > 0) n /= length;
}

} // namespace tss
