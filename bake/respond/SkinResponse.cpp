#include "bake/respond/SkinResponse.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Times that contacts are looked up, at most, after the first time where those before have moved the skin
/// to: new ones are met there, and planes of curved surfaces have turned.
constexpr int lookUps = 6;
/// In sizes of the skin: what is not deeper than this needs no further look-up.
constexpr float settled = 1e-5f;

double activationOf(std::span<const double> activations, const SkinBody& body, std::size_t m) {
    const double a = m < activations.size() ? activations[m] : 0;
    return std::isnan(a) || body.nodes.empty() ? 0 : std::clamp(a, body.nodes.front(), body.nodes.back());
}

} // namespace

SkinResponse::SkinResponse(std::shared_ptr<const SkinRig> rig)
    : rig_(std::move(rig)), pushes_(rig_->foundation), planeOf_(rig_->rows.size(), 0), positions_(rig_->rest),
      normals_(rig_->restNormals), activations_(rig_->bodies.size(), 0),
      poses_(rig_->bodies.size(), Pose::Identity()) {
    normalSums_.resize(rig_->rest.size() + rig_->border.size());
}

SkinUpdate SkinResponse::update(std::span<const double> activations, std::span<const Pose> poses) {
    bool same = true, rest = true;
    for (std::size_t m = 0; m < rig_->bodies.size(); ++m) {
        const double a = activationOf(activations, rig_->bodies[m], m);
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
    if (!same || atRest_) {
        atRest_ = false;
        result.moved = true;
        if (rig_->parameters.faithful) {
            positions_ = rig_->rest;
            contacts_ = pushOut(rig_->spheres, activations_, poses_, rig_->restNormals, positions_);
            scene_.skin.resize(positions_.size(), Move::Zero());
            for (std::size_t v = 0; v < positions_.size(); ++v)
                scene_.skin[v].head<3>() = ((positions_[v] - rig_->centre) / rig_->size).cast<float>();
        } else {
            placeBodies(*rig_, activations_, poses_, scene_);
            start_ = scene_.skin;
            resist();
            for (std::size_t v = 0; v < positions_.size(); ++v)
                positions_[v] =
                    rig_->rest[v] + rig_->size * (scene_.skin[v] - rig_->places[v]).head<3>().cast<double>();
        }
        findNormals();
    }
    result.contacts = contacts_;
    return result;
}

void SkinResponse::toRest() {
    positions_ = rig_->rest;
    normals_ = rig_->restNormals;
    residual_ = 0;
    contacts_ = 0;
    atRest_ = true;
}

/// The skin leaves what it is carried into.
void SkinResponse::resist() {
    for (const std::uint32_t r : rows_) planeOf_[r] = 0;
    rows_.clear();
    planes_.clear();
    pushes_.clear();
    residual_ = 0;
    contacts_ = 0;
    for (int round = 0; round < lookUps; ++round) {
        bool open = false;
        for (std::uint32_t r = 0; r < rig_->rows.size(); ++r) {
            if (planeOf_[r] > 0) {
                SkinPlane& plane = planes_[planeOf_[r] - 1];
                lookAgain(*rig_, scene_, rig_->rows[r], plane);
                open = open || plane.gap < -settled;
                continue;
            }
            if (!mayMeet(*rig_, scene_, rig_->rows[r])) continue;
            const SkinPlane plane = lookUp(*rig_, scene_, rig_->rows[r]);
            if (!plane.found() || !(plane.gap < 0)) continue;
            rows_.push_back(r);
            planes_.push_back(plane);
            planeOf_[r] = static_cast<std::uint32_t>(planes_.size());
            open = true;
        }
        if (!open) break;
        residual_ =
            rig_->size * static_cast<double>(pushes_.solve(planes_, start_, rig_->parameters.iterations));
        scene_.skin = start_;
        contacts_ = pushes_.apply(planes_, scene_.skin);
    }
}

void SkinResponse::findNormals() {
    std::fill(normalSums_.begin(), normalSums_.end(), Move::Zero());
    const std::size_t inside = positions_.size();
    const auto at = [&](int v) -> const Move& {
        const auto u = static_cast<std::size_t>(v);
        return u < inside ? scene_.skin[u] : rig_->borderPlaces[u - inside];
    };
    for (const Tri& t : rig_->normalTriangles) {
        const Move a = at(t[0]), n = (at(t[1]) - a).cross3(at(t[2]) - a);
        for (int k = 0; k < 3; ++k) normalSums_[t[k]] += n;
    }
    for (std::size_t v = 0; v < inside; ++v) {
        const float squared = normalSums_[v].head<3>().squaredNorm();
        normals_[v] = squared > 0 ? Vec3((normalSums_[v].head<3>() / std::sqrt(squared)).cast<double>())
                                  : rig_->restNormals[v];
    }
}

} // namespace tss
