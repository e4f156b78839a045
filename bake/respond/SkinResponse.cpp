#include "bake/respond/SkinResponse.h"

#include "bake/respond/SkinPushes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tss {
namespace {

/// Times that contacts are looked up, at most, after the first time where those before have moved the skin
/// to: new ones are met there, and planes of curved surfaces have turned.
constexpr int lookUps = 10;
/// In sizes of the skin: what is not deeper than this needs no further look-up.
constexpr float settled = 1e-5f;

double activationOf(std::span<const double> activations, const SkinBody& body, std::size_t m) {
    const double a = m < activations.size() ? activations[m] : 0;
    return std::isnan(a) || body.nodes.empty() ? 0 : std::clamp(a, body.nodes.front(), body.nodes.back());
}

} // namespace

/// All of a response: its rig, and what the last update left.
class SkinResponse::State {
public:
    explicit State(std::shared_ptr<const SkinRig> rig);
    SkinUpdate update(std::span<const double> activations, std::span<const Pose> poses,
                      std::span<const Vec3> shift);
    std::span<const Vec3> positions() const { return positions_; }
    std::span<const Vec3> normals() const { return normals_; }
    const SkinRig& rig() const { return *rig_; }
    double residual() const { return residual_; }

private:
    /// A row that was looked up in this update and lacks nothing: not before it has come nearer by this much.
    struct Seen {
        SkinPlane plane;
        Eigen::Vector3f place; ///< of what the plane holds, then
        float free = 0;
    };
    /// A row that lacks something, and where: of each place the deepest is chosen.
    struct Found {
        std::uint64_t place = 0;
        std::uint32_t row = 0;
        SkinPlane plane;
    };
    bool shiftBy(std::span<const Vec3> shift);
    std::uint64_t placeOfChoice(const SkinRow& row, const SkinPlane& plane) const;
    Seen seen(const SkinRow& row, const SkinPlane& plane) const;
    bool mayPush(std::uint32_t r) const;
    void findStirred();
    bool stirred(std::uint32_t r) const;
    void toRest();
    void addDeepest();
    void resist();
    void findNormals();

    std::shared_ptr<const SkinRig> rig_;
    SkinScene scene_;
    SkinPushes pushes_;
    std::vector<SkinPlane> planes_;
    std::vector<std::uint32_t> rows_;    ///< of planes_
    std::vector<std::uint32_t> planeOf_; ///< #rows: 1 + its place in planes_, 0: none
    std::vector<Found> found_;
    std::vector<Seen> seen_;
    std::vector<std::uint32_t> seenRows_; ///< of seen_
    std::vector<std::uint32_t> seenOf_;   ///< #rows: 1 + its place in seen_, 0: none
    std::vector<Move> start_;             ///< the skin as it is carried
    std::vector<char> stirred_;           ///< #touched: contacts have moved it
    std::vector<char> lacking_;           ///< #rows: when last looked up, another one was chosen
    std::vector<Vec3> positions_, normals_;
    std::vector<Move> normalSums_;
    std::vector<double> activations_;
    std::vector<Pose> poses_;
    std::vector<Vec3> shift_; ///< #touched; empty: none
    double residual_ = 0;
    std::size_t contacts_ = 0;
    bool atRest_ = true;
};

SkinResponse::State::State(std::shared_ptr<const SkinRig> rig)
    : rig_(std::move(rig)), pushes_(rig_->foundation), planeOf_(rig_->rows.size(), 0),
      seenOf_(rig_->rows.size(), 0), positions_(rig_->rest), normals_(rig_->restNormals),
      activations_(rig_->bodies.size(), 0), poses_(rig_->bodies.size(), Pose::Identity()) {
    normalSums_.resize(rig_->rest.size() + rig_->border.size());
}

/// Takes it over, and returns whether it was that already.
bool SkinResponse::State::shiftBy(std::span<const Vec3> shift) {
    const bool none = std::all_of(shift.begin(), shift.end(), [](const Vec3& s) { return s.isZero(0); });
    if (none || shift.size() != rig_->vertices.size()) shift = {};
    if (std::equal(shift.begin(), shift.end(), shift_.begin(), shift_.end())) return true;
    shift_.assign(shift.begin(), shift.end());
    return false;
}

SkinUpdate SkinResponse::State::update(std::span<const double> activations, std::span<const Pose> poses,
                                       std::span<const Vec3> shift) {
    bool same = shiftBy(shift), rest = shift_.empty();
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
            placeBodies(*rig_, activations_, poses_, shift_, scene_);
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

void SkinResponse::State::toRest() {
    positions_ = rig_->rest;
    normals_ = rig_->restNormals;
    residual_ = 0;
    contacts_ = 0;
    atRest_ = true;
}

/// What a row that lacks nothing keeps until contacts have moved the skin there. Where nothing faced it, any
/// move may change that, but those that no look-up would notice.
SkinResponse::State::Seen SkinResponse::State::seen(const SkinRow& row, const SkinPlane& plane) const {
    Seen seen{plane, {}, 0};
    if (plane.found()) {
        seen.free = std::max(std::min(plane.gap, plane.distance - row.offset), 0.0f) / 2;
    } else if (row.meeting == SkinMeeting::BodyOnSkin) {
        seen.plane.vertices = 3;
        for (int k = 0; k < 3; ++k) {
            seen.plane.vertex[k] = static_cast<std::uint32_t>(row.corners[k]);
            seen.plane.weight[k] = row.weights[k];
        }
    } else {
        seen.plane.vertices = 1;
        seen.plane.vertex[0] = row.vertex;
        seen.plane.weight[0] = 1;
    }
    seen.free = std::max(seen.free, settled);
    seen.place = placeOf(scene_, seen.plane);
    return seen;
}

bool SkinResponse::State::mayPush(std::uint32_t r) const {
    if (seenOf_[r] == 0) return mayMeet(*rig_, scene_, rig_->rows[r]);
    const Seen& seen = seen_[seenOf_[r] - 1];
    return (placeOf(scene_, seen.plane) - seen.place).squaredNorm() > seen.free * seen.free;
}

/// Which vertices contacts have moved from where they were carried to.
void SkinResponse::State::findStirred() {
    constexpr float still = settled * settled;
    for (std::size_t v = 0; v < start_.size(); ++v)
        stirred_[v] = (scene_.skin[v] - start_[v]).squaredNorm() > still;
}

/// Whether that is so of any that a row depends on.
bool SkinResponse::State::stirred(std::uint32_t r) const {
    if (lacking_[r]) return true;
    bool any = false;
    if (seenOf_[r] > 0) {
        const SkinPlane& plane = seen_[seenOf_[r] - 1].plane;
        for (int k = 0; k < plane.vertices; ++k) any = any || stirred_[plane.vertex[k]];
        return any;
    }
    const SkinRow& row = rig_->rows[r];
    if (row.meeting != SkinMeeting::BodyOnSkin) any = stirred_[row.vertex];
    if (row.meeting != SkinMeeting::SkinOnBody)
        for (const int corner : row.corners) any = any || stirred_[corner];
    return any;
}

/// Where a plane is found for the choice of the deepest: the node that bears most on it, and what meets.
std::uint64_t SkinResponse::State::placeOfChoice(const SkinRow& row, const SkinPlane& plane) const {
    const SkinFoundation& f = rig_->foundation;
    const std::uint32_t first = f.start[plane.vertex[0]], last = f.start[plane.vertex[0] + 1];
    const auto most = std::max_element(f.weight.begin() + first, f.weight.begin() + last);
    const std::uint64_t node = first == last ? f.nodes : f.node[most - f.weight.begin()];
    return (node * 3 + static_cast<std::uint64_t>(row.meeting)) * rig_->bodies.size() + row.body;
}

/// Of the planes that were found, the deepest at each node and body: pushes act through nodes, so that most
/// of the others are met by it, and what is not is found again at the next look-up.
void SkinResponse::State::addDeepest() {
    std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) {
        return std::tie(a.place, a.plane.gap, a.row) < std::tie(b.place, b.plane.gap, b.row);
    });
    for (std::size_t k = 0; k < found_.size(); ++k) {
        if (k > 0 && found_[k].place == found_[k - 1].place) continue;
        rows_.push_back(found_[k].row);
        planes_.push_back(found_[k].plane);
        planeOf_[found_[k].row] = static_cast<std::uint32_t>(planes_.size());
    }
    found_.clear();
}

/// The skin leaves what it is carried into.
void SkinResponse::State::resist() {
    for (const std::uint32_t r : rows_) planeOf_[r] = 0;
    for (const std::uint32_t r : seenRows_) seenOf_[r] = 0;
    rows_.clear();
    seenRows_.clear();
    planes_.clear();
    seen_.clear();
    pushes_.clear();
    residual_ = 0;
    contacts_ = 0;
    stirred_.resize(start_.size());
    lacking_.assign(rig_->rows.size(), 0);
    for (int round = 0; round < lookUps; ++round) {
        bool open = false;
        for (std::uint32_t r = 0; r < rig_->rows.size(); ++r) {
            const SkinRow& row = rig_->rows[r];
            if (planeOf_[r] > 0) {
                SkinPlane& plane = planes_[planeOf_[r] - 1];
                lookAgain(*rig_, scene_, row, plane);
                open = open || plane.gap < -settled;
                continue;
            }
            if ((round > 0 && !stirred(r)) || !mayPush(r)) continue;
            const SkinPlane plane = lookUp(*rig_, scene_, row);
            lacking_[r] = plane.found() && plane.gap < 0;
            if (!lacking_[r]) {
                if (seenOf_[r] == 0) {
                    seenRows_.push_back(r);
                    seenOf_[r] = static_cast<std::uint32_t>(seenRows_.size());
                    seen_.emplace_back();
                }
                seen_[seenOf_[r] - 1] = seen(row, plane);
                continue;
            }
            found_.push_back({placeOfChoice(row, plane), r, plane});
            open = true;
        }
        addDeepest();
        if (!open) break;
        residual_ =
            rig_->size * static_cast<double>(pushes_.solve(planes_, start_, rig_->parameters.iterations));
        scene_.skin = start_;
        contacts_ = pushes_.apply(planes_, scene_.skin);
        findStirred();
    }
}

void SkinResponse::State::findNormals() {
    std::fill(normalSums_.begin(), normalSums_.end(), Move::Zero());
    const std::size_t inside = positions_.size();
    const auto add = [&](const Tri& t, const Move& a, const Move& b, const Move& c) {
        const Move n = (b - a).cross3(c - a);
        for (int k = 0; k < 3; ++k) normalSums_[t[k]] += n;
    };
    const std::vector<Move>& skin = scene_.skin;
    for (const Tri& t : rig_->triangles) add(t, skin[t[0]], skin[t[1]], skin[t[2]]);
    const auto at = [&](int v) -> const Move& {
        const auto u = static_cast<std::size_t>(v);
        return u < inside ? skin[u] : rig_->borderPlaces[u - inside];
    };
    for (const Tri& t : rig_->borderTriangles) add(t, at(t[0]), at(t[1]), at(t[2]));
    for (std::size_t v = 0; v < inside; ++v) {
        const float squared = normalSums_[v].head<3>().squaredNorm();
        normals_[v] = squared > 0 ? Vec3((normalSums_[v].head<3>() / std::sqrt(squared)).cast<double>())
                                  : rig_->restNormals[v];
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
    return state_->rig().vertices;
}

std::span<const Vec3> SkinResponse::positions() const {
    return state_->positions();
}

std::span<const Vec3> SkinResponse::normals() const {
    return state_->normals();
}

const SkinRig& SkinResponse::rig() const {
    return state_->rig();
}

double SkinResponse::residual() const {
    return state_->residual();
}

} // namespace tss
