#include "bake/respond/SkinResponse.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Change of a displacement in a sweep, as a share of the skin's size, at which the skin has settled.
constexpr double settledShare = 2e-9;
/// What skin may have moved since all around it was last balanced before it is balanced anew, as a share of
/// the largest move of all, at one sweep an update; the more sweeps, the less. Where nothing changes any more
/// all of it is.
constexpr double calmShare = 0.05;
constexpr int pushRounds = 8; ///< of the faithful mode

double activationOf(std::span<const double> activations, const SkinMuscle& muscle, std::size_t m) {
    const double a = m < activations.size() ? activations[m] : 0;
    const std::vector<double>& nodes = muscle.surface.nodes;
    return std::isnan(a) || nodes.empty() ? 0 : std::clamp(a, nodes.front(), nodes.back());
}

} // namespace

SkinResponse::SkinResponse(std::shared_ptr<const SkinRig> rig)
    : rig_(std::move(rig)), solver_(rig_->contactPatch.sheet), strain_(rig_->weave), watch_(*rig_),
      planes_(rig_->rows.size() + rig_->pokes.size() + rig_->folds.size()),
      still_(rig_->contactPatch.vertices.size(), Move::Zero()), positions_(rig_->rest),
      normals_(rig_->restNormals), kernels_(skinKernels()), activations_(rig_->muscles.size(), 0),
      poses_(rig_->muscles.size(), Pose::Identity()) {
    places_.resize(rig_->rest.size() + rig_->border.size(), SkinPlace::Zero());
    for (std::size_t b = 0; b < rig_->border.size(); ++b)
        places_[rig_->rest.size() + b].head<3>() = rig_->border[b];
    normalSums_.resize(places_.size());
}

SkinUpdate SkinResponse::update(std::span<const double> activations, std::span<const Pose> poses) {
    bool same = true, rest = true;
    for (std::size_t m = 0; m < rig_->muscles.size(); ++m) {
        const double a = activationOf(activations, rig_->muscles[m], m);
        same = same && a == activations_[m];
        rest = rest && a == 0;
        activations_[m] = a;
        const Pose pose = m < poses.size() && poses[m].matrix().allFinite() ? poses[m] : Pose::Identity();
        same = same && pose.matrix() == poses_[m].matrix();
        rest = rest && pose.matrix() == Pose::Identity().matrix();
        poses_[m] = pose;
    }
    SkinUpdate result;
    result.rest = rest;
    if (rest) {
        result.moved = !atRest_;
        if (!atRest_) toRest();
        return result;
    }
    if (!same || !settled_) {
        atRest_ = false;
        result.moved = true;
        placeMuscles(*rig_, activations_, poses_, scene_);
        if (rig_->parameters.faithful)
            pushOut();
        else
            solve(same);
        findNormals();
    }
    for (const SheetPlane& p : planes_) result.contacts += p.multiplier > 0;
    return result;
}

void SkinResponse::toRest() {
    solver_.reset();
    watch_.forget();
    std::fill(planes_.begin(), planes_.end(), SheetPlane{});
    positions_ = rig_->rest;
    normals_ = rig_->restNormals;
    residual_ = largest_ = 0;
    settled_ = atRest_ = true;
}

/// [paper] Each skin sphere leaves the muscle sphere that it is deepest in, until it is in none.
void SkinResponse::pushOut() {
    positions_ = rig_->rest;
    for (std::size_t r = 0; r < rig_->rows.size(); ++r) {
        const SkinRow& row = rig_->rows[r];
        const PlacedMuscle& muscle = scene_.muscles[row.muscle];
        Vec3 x = positions_[row.vertex];
        for (int round = 0; round < pushRounds; ++round) {
            double deepest = 0;
            Vec3 push = Vec3::Zero();
            for (std::uint32_t k = row.first; k < row.last; ++k) {
                const SkinTest& test = rig_->tests[k];
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
        positions_[row.vertex] = x;
        planes_[r].multiplier = static_cast<float>((x - rig_->rest[row.vertex]).norm());
    }
    settled_ = true;
    residual_ = 0;
}

void SkinResponse::solve(bool same) {
    findContacts(same);
    const int sweeps = rig_->parameters.iterations;
    const float tolerance = static_cast<float>(settledShare * rig_->size);
    const float calm = static_cast<float>(calmShare * largest_ / sweeps);
    const std::vector<std::uint32_t>& patch = rig_->contactPatch.vertices;
    residual_ = same ? solver_.solve(still_, planes_, sweeps, tolerance)
                     : solver_.follow(planes_, sweeps, tolerance, calm);
    settled_ = same && residual_ <= tolerance;
    const std::span<const Move> moves = solver_.displacements();
    positions_ = scene_.predicted;
    float largest = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
        largest = std::max(largest, moves[i].head<3>().squaredNorm());
        positions_[patch[i]] += scene_.turn.turned(patch[i], moves[i].head<3>().cast<double>());
    }
    largest_ = std::sqrt(static_cast<double>(largest));
    strain_.relax(rig_->rest, planes_, patch, scene_.drag, scene_.turn, positions_);
}

void SkinResponse::findContacts(bool same) {
    const std::size_t rows = rig_->rows.size(), pokes = rows + rig_->pokes.size();
    const std::span<const std::uint32_t> patch = rig_->contactPatch.vertices;
    for (std::size_t i = 0; i < planes_.size(); ++i) {
        SheetPlane& plane = planes_[i];
        if (!same && !watch_.due(*rig_, scene_, i, solver_.slack(plane))) continue;
        const SkinContact contact = i < rows    ? rowContact(*rig_, scene_, i)
                                    : i < pokes ? pokeContact(*rig_, scene_, i - rows)
                                                : foldContact(*rig_, scene_, i - pokes);
        const double offset = i < rows    ? rig_->rowOffsets[i]
                              : i < pokes ? rig_->pokeOffsets[i - rows]
                                          : rig_->foldOffsets[i - pokes];
        const double radius = i < rows    ? rig_->rows[i].radius
                              : i < pokes ? rig_->pokes[i - rows].radius
                                          : rig_->foldRadius;
        watch_.note(*rig_, scene_, i, contact);
        Vec3 predicted = Vec3::Zero();
        for (int k = 0; k < contact.vertices; ++k)
            predicted +=
                contact.weight[k] * (scene_.predicted[contact.vertex[k]] - rig_->rest[contact.vertex[k]]);
        const double distance = contact.distance + contact.normal.dot(predicted);
        // What is not quite believed asks for less, so that contacts come and go without a jump.
        const double depth = offset - distance;
        const double excess = (1 - contact.trust) * (std::max(depth, 0.0) + radius);
        double bound = offset - contact.distance - excess;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = contact.vertex[k];
            const std::uint32_t inPatch = rig_->contactIndex[v];
            const bool moves = inPatch != SkinRig::outside;
            plane.vertex[k] = moves ? inPatch : 0;
            plane.weight[k] = moves ? static_cast<float>(contact.weight[k]) : 0.0f;
            bound -= contact.weight[k] * contact.normal.dot(scene_.drag[v].head<3>().cast<double>());
        }
        plane.vertices = contact.vertices;
        plane.bound = static_cast<float>(bound);
        // The sheet is solved as it lies at rest, wherever bones have turned it.
        Vec3 asAtRest = contact.normal;
        if (!scene_.turn.none()) asAtRest = scene_.turn.of(cornersOf(plane, patch)).inverse() * asAtRest;
        Move normal = Move::Zero();
        normal.head<3>() = asAtRest.cast<float>();
        // A push carried over to a normal that has turned away would cycle.
        if (normal.dot(plane.normal) < 0.5f) plane.multiplier = 0;
        plane.normal = normal;
    }
}

void SkinResponse::findNormals() {
    for (std::size_t v = 0; v < positions_.size(); ++v) places_[v].head<3>() = positions_[v];
    std::fill(normalSums_.begin(), normalSums_.end(), SkinPlace::Zero());
    kernels_.normals(rig_->normalTriangles, places_.data(), normalSums_.data());
    kernels_.normalise(normalSums_.data(), normals_);
}

} // namespace tss
