#include "bake/respond/SkinResponse.h"

#include "bake/respond/SkinContactSolver.h"
#include "bake/respond/SkinNormalKernel.h"

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

/// The implementation of a response: its rig, and the state of the last update.
class SkinResponse::State {
public:
    explicit State(std::shared_ptr<const SkinRig> rig);
    SkinUpdate update(std::span<const double> activations, std::span<const Pose> poses,
                      std::span<const Vec3> shift);
    bool setShift(std::span<const Vec3> shift);
    void deform();
    void toRest();
    void showPlaces(std::size_t block);
    void showNormals(std::size_t block);
    void show();

    std::shared_ptr<const SkinRig> rig_;
    SkinScene scene_;
    SkinContactSolver contactSolver_;
    SkinClock clock_;
    SkinNormalKernel normalKernel_ = skinNormalKernel(bestTarget());
    std::vector<Vec3> positions_, normals_;
    std::vector<char> shown_, shownBefore_; ///< #blocks: positions or normals are not those at rest
    std::vector<double> activations_;
    std::vector<Pose> poses_;
    std::vector<Vec3> shift_; ///< #touched; empty: none
    std::size_t contacts_ = 0;
    double pushed_ = 0; ///< as SkinUpdate has it
    bool atRest_ = true;
};

SkinResponse::State::State(std::shared_ptr<const SkinRig> rig)
    : rig_(std::move(rig)), contactSolver_(*rig_, clock_), positions_(rig_->rest),
      normals_(rig_->restNormals), shown_(rig_->blocks(), 0), activations_(rig_->bodies.size(), 0),
      poses_(rig_->bodies.size(), Pose::Identity()) {}

/// Stores the shift; returns whether it is the same as before.
bool SkinResponse::State::setShift(std::span<const Vec3> shift) {
    const bool none = std::all_of(shift.begin(), shift.end(), [](const Vec3& s) { return s.isZero(0); });
    if (none || shift.size() != rig_->vertices.size()) shift = {};
    if (std::equal(shift.begin(), shift.end(), shift_.begin(), shift_.end())) return true;
    shift_.assign(shift.begin(), shift.end());
    return false;
}

SkinUpdate SkinResponse::State::update(std::span<const double> activations, std::span<const Pose> poses,
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
        deform();
        show();
    }
    result.contacts = contacts_;
    result.pushed = pushed_;
    return result;
}

void SkinResponse::State::deform() {
    if (clock_.costs != nullptr) ++clock_.costs->updates;
    {
        const SkinClock::Scope scope(clock_, SkinPart::Carry);
        contactSolver_.undoPushes(scene_);
        placeBodies(*rig_, activations_, poses_, shift_, scene_);
    }
    contacts_ = contactSolver_.push(scene_);
    pushed_ = contacts_ > 0 ? rig_->size * static_cast<double>(contactSolver_.farthest()) : 0;
}

void SkinResponse::State::toRest() {
    positions_ = rig_->rest;
    normals_ = rig_->restNormals;
    contacts_ = 0;
    pushed_ = 0;
    atRest_ = true;
}

/// Copies the positions of a block to the output, scene units.
void SkinResponse::State::showPlaces(std::size_t block) {
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

void SkinResponse::State::showNormals(std::size_t block) {
    const std::size_t first = block * SkinRig::block,
                      count = std::min(SkinRig::block, rig_->places.size() - first);
    float found[3 * SkinRig::block + 1];
    const bool all = normalKernel_({rig_->rings, scene_.skin[0].data(), rig_->inverted ? -1.0f : 1.0f},
                                   first / 2, (first + count + 1) / 2, found);
    double* normal = normals_[first].data();
    for (std::size_t k = 0; k < 3 * count; ++k) normal[k] = static_cast<double>(found[k]);
    for (std::size_t v = first; v < first + count && !all; ++v)
        if (normals_[v].isZero(0)) normals_[v] = rig_->restNormals[v];
}

/// Updates the output where skin has moved, the normals around it, and what is back at rest.
void SkinResponse::State::show() {
    const SkinClock::Scope scope(clock_, SkinPart::Show);
    shownBefore_.swap(shown_);
    shown_.assign(rig_->blocks(), 0);
    for (std::size_t b = 0; b < shown_.size(); ++b)
        if (scene_.live[b] != 0 || contactSolver_.pushed(b))
            for (const std::uint32_t around : rig_->around[b]) shown_[around] = 1;
    for (std::size_t b = 0; b < shown_.size(); ++b)
        if (shown_[b] != 0 || shownBefore_[b] != 0) showPlaces(b);
    for (std::size_t b = 0; b < shown_.size(); ++b) {
        if (shown_[b] != 0) {
            showNormals(b);
        } else if (shownBefore_[b] != 0) {
            const auto first = static_cast<std::ptrdiff_t>(b * SkinRig::block);
            const auto count = std::min(SkinRig::block, rig_->places.size() - b * SkinRig::block);
            std::copy_n(rig_->restNormals.begin() + first, count, normals_.begin() + first);
        }
    }
    for (std::size_t k = 0, v = rig_->places.size(); k < rig_->twins.size(); ++k, ++v) {
        positions_[v] = positions_[rig_->twins[k]];
        normals_[v] = normals_[rig_->twins[k]];
    }
}

SkinResponse::SkinResponse(std::shared_ptr<const SkinRig> rig)
    : state_(std::make_unique<State>(std::move(rig))) {}
SkinResponse::SkinResponse(SkinResponse&&) noexcept = default;
SkinResponse& SkinResponse::operator=(SkinResponse&&) noexcept = default;
SkinResponse::~SkinResponse() = default;

SkinUpdate SkinResponse::update(std::span<const double> activations, std::span<const Pose> poses,
                                std::span<const Vec3> shift) {
    return state_->update(activations, poses, shift);
}

std::span<const std::uint32_t> SkinResponse::vertices() const {
    return state_->rig_->vertices;
}

std::span<const Vec3> SkinResponse::positions() const {
    return state_->positions_;
}

std::span<const Vec3> SkinResponse::normals() const {
    return state_->normals_;
}

const SkinRig& SkinResponse::rig() const {
    return *state_->rig_;
}

void SkinResponse::charge(SkinCosts* costs) {
    state_->clock_.costs = costs;
}

} // namespace tss
