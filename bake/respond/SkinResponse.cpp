#include "bake/respond/SkinResponse.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

double activationOf(std::span<const double> activations, const SkinBody& body, std::size_t m) {
    const double a = m < activations.size() ? activations[m] : 0;
    return std::isnan(a) || body.nodes.empty() ? 0 : std::clamp(a, body.nodes.front(), body.nodes.back());
}

/// Whether squared lengths of a pose fit into floats; other poses count as the identity.
bool isUsable(const Pose& pose) {
    constexpr double most = 1e15; // scene units
    return pose.matrix().allFinite() && pose.matrix().cwiseAbs().maxCoeff() < most;
}

} // namespace

SkinResponse::SkinResponse(std::shared_ptr<const SkinRig> rig)
    : rig_(std::move(rig)), contacts_(*rig_), positions_(rig_->rest), normals_(rig_->restNormals),
      shown_(rig_->blocks(), 0), activations_(rig_->bodies.size(), 0),
      poses_(rig_->bodies.size(), Pose::Identity()) {}

/// Stores the shift; returns whether it is the same as before.
bool SkinResponse::setShift(std::span<const Vec3> shift) {
    const bool none = std::ranges::all_of(shift, [](const Vec3& s) { return s.isZero(0); });
    if (none || shift.size() != rig_->vertices.size()) shift = {};
    if (std::ranges::equal(shift, shift_)) return true;
    shift_.assign(shift.begin(), shift.end());
    return false;
}

SkinUpdate SkinResponse::update(std::span<const double> activations, std::span<const Pose> poses,
                                std::span<const Vec3> shift) {
    bool same = setShift(shift), rest = shift_.empty();
    for (std::size_t m = 0; m < rig_->bodies.size(); ++m) {
        const double a = activationOf(activations, rig_->bodies[m], m);
        same = same && a == activations_[m];
        rest = rest && a == 0;
        activations_[m] = a;
        const Pose pose = m < poses.size() && isUsable(poses[m]) ? poses[m] : Pose::Identity();
        same = same && pose.matrix() == poses_[m].matrix();
        rest = rest && isIdentity(pose);
        poses_[m] = pose;
    }
    last_.moved = rest != last_.rest || (!rest && !same);
    last_.rest = rest;
    if (!last_.moved) return last_;
    if (rest) {
        positions_ = rig_->rest;
        normals_ = rig_->restNormals;
        last_.contacts = 0;
        last_.pushed = 0;
        return last_;
    }
    SkinClock& clock = contacts_.clock;
    if (clock.costs != nullptr) ++clock.costs->updates;
    clock.start();
    contacts_.undoPushes(scene_);
    placeBodies(*rig_, activations_, poses_, shift_, scene_);
    clock.charge(SkinPart::Carry);
    last_.contacts = contacts_.push(scene_);
    last_.pushed = last_.contacts > 0 ? rig_->size * static_cast<double>(contacts_.farthest()) : 0;
    show();
    clock.charge(SkinPart::Show);
    return last_;
}

/// Copies the positions of a block to the output, scene units.
void SkinResponse::showPlaces(std::size_t block) {
    const std::size_t first = block * SkinRig::block,
                      count = std::min(SkinRig::block, rig_->places.size() - first);
    const Move *skin = scene_.skin.data() + first, *places = rig_->places.data() + first;
    float moved[3 * SkinRig::block + 1];
    for (std::size_t v = 0; v < count; ++v) Eigen::Map<Move>(moved + 3 * v) = skin[v] - places[v];
    const double size = rig_->size;
    const double* rest = rig_->rest[first].data();
    double* position = positions_[first].data();
    for (std::size_t k = 0; k < 3 * count; ++k) position[k] = rest[k] + size * static_cast<double>(moved[k]);
}

void SkinResponse::showNormals(std::size_t block) {
    const std::size_t first = block * SkinRig::block,
                      count = std::min(SkinRig::block, rig_->places.size() - first);
    float found[3 * SkinRig::block + 1];
    const bool all = normalKernel_(rig_->rings, scene_.skin[0].data(), rig_->inverted ? -1.0f : 1.0f,
                                   first / 2, (first + count + 1) / 2, found);
    double* normal = normals_[first].data();
    for (std::size_t k = 0; k < 3 * count; ++k) normal[k] = static_cast<double>(found[k]);
    for (std::size_t v = first; v < first + count && !all; ++v)
        if (normals_[v].isZero(0)) normals_[v] = rig_->restNormals[v];
}

/// Updates the output where skin has moved, the normals around it, and what is back at rest.
void SkinResponse::show() {
    shownBefore_.swap(shown_);
    shown_.assign(rig_->blocks(), 0);
    for (std::size_t b = 0; b < shown_.size(); ++b)
        if (scene_.live[b] != 0 || contacts_.pushed(b))
            for (const std::uint32_t around : rig_->around[b]) shown_[around] = 1;
    for (std::size_t b = 0; b < shown_.size(); ++b) {
        if (shown_[b] != 0 || shownBefore_[b] != 0) showPlaces(b);
        if (shown_[b] != 0) {
            showNormals(b);
        } else if (shownBefore_[b] != 0) {
            const auto [first, last] = rig_->verticesOf(b);
            std::copy_n(rig_->restNormals.begin() + first, last - first, normals_.begin() + first);
        }
    }
    for (std::size_t k = 0, v = rig_->places.size(); k < rig_->twins.size(); ++k, ++v) {
        positions_[v] = positions_[rig_->twins[k]];
        normals_[v] = normals_[rig_->twins[k]];
    }
}

} // namespace tss
