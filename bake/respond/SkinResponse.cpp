#include "bake/respond/SkinResponse.h"

#include "bake/respond/SkinPushes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace tss {
namespace {

/// Times that contacts are looked up, at most, after the first time where those before have moved the skin
/// to: new ones are met there, and planes of curved surfaces have turned.
constexpr int lookUps = 10;
/// In sizes of the skin: what is not deeper than this needs no further look-up.
constexpr float settled = 1e-5f;
/// In radii of the skin: what was before no body is looked up again where contacts have moved it by this.
/// Deeper it does not get into a body unnoticed.
constexpr float unnoticed = 0.2f;
/// Without new contacts, what is deepest has to get less deep by this factor, or what is asked for is more
/// than the skin can give, and no further look-up helps.
constexpr float progress = 0.5f;

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
    void takeBack();
    void findStirred();
    bool stirred(std::uint32_t r) const;
    void toRest();
    void addDeepest();
    void resist();
    void showPlaces(std::size_t block);
    void showNormals(std::size_t block);
    void show();

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
    std::vector<char> pushed_;            ///< #blocks: with vertices that contacts may have moved
    std::vector<char> stirred_;           ///< #touched: contacts have moved it
    std::vector<char> lacking_;           ///< #rows: when last looked up, another one was chosen
    std::vector<Vec3> positions_, normals_;
    std::vector<Move> turned_;              ///< #touched, then the border: y, z, x of the places
    std::vector<char> shown_, shownBefore_; ///< #blocks: places and normals are not those at rest
    std::vector<double> activations_;
    std::vector<Pose> poses_;
    std::vector<Vec3> shift_; ///< #touched; empty: none
    double residual_ = 0;
    std::size_t contacts_ = 0;
    bool atRest_ = true;
};

SkinResponse::State::State(std::shared_ptr<const SkinRig> rig)
    : rig_(std::move(rig)), pushes_(rig_->foundation), planeOf_(rig_->rows.size(), 0),
      seenOf_(rig_->rows.size(), 0), pushed_(rig_->blocks(), 0), stirred_(rig_->rest.size(), 0),
      positions_(rig_->rest), normals_(rig_->restNormals), shown_(rig_->blocks(), 0),
      activations_(rig_->bodies.size(), 0), poses_(rig_->bodies.size(), Pose::Identity()) {
    for (const auto* places : {&rig_->places, &rig_->borderPlaces})
        for (const Move& x : *places) turned_.emplace_back(x[1], x[2], x[0], 0);
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
            scene_.skin = rig_->places;
            scene_.skin.insert(scene_.skin.end(), rig_->borderPlaces.begin(), rig_->borderPlaces.end());
            for (std::size_t v = 0; v < positions_.size(); ++v)
                scene_.skin[v].head<3>() = ((positions_[v] - rig_->centre) / rig_->size).cast<float>();
            scene_.live.assign(rig_->blocks(), 1);
        } else {
            takeBack();
            placeBodies(*rig_, activations_, poses_, shift_, scene_);
            resist();
        }
        show();
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

/// What a row that lacks nothing keeps until contacts have moved the skin there.
SkinResponse::State::Seen SkinResponse::State::seen(const SkinRow& row, const SkinPlane& plane) const {
    Seen seen{plane, {}, 0};
    if (plane.found()) {
        seen.free = std::max(std::min(plane.gap, plane.distance - row.offset) / 2, settled);
    } else if (row.meeting == SkinMeeting::SkinOnBody) {
        seen.free = unnoticed * rig_->radius;
    } else {
        seen.free = std::max(distanceToKnown(*rig_, scene_, row) / 2, settled);
    }
    if (!plane.found() && row.meeting == SkinMeeting::BodyOnSkin) {
        seen.plane.vertices = 3;
        for (int k = 0; k < 3; ++k) {
            seen.plane.vertex[k] = static_cast<std::uint32_t>(row.corners[k]);
            seen.plane.weight[k] = row.weights[k];
        }
    } else if (!plane.found()) {
        seen.plane.vertices = 1;
        seen.plane.vertex[0] = row.vertex;
        seen.plane.weight[0] = 1;
    }
    seen.place = placeOf(scene_, seen.plane);
    return seen;
}

bool SkinResponse::State::mayPush(std::uint32_t r) const {
    if (seenOf_[r] == 0) return mayMeet(*rig_, scene_, rig_->rows[r]);
    const Seen& seen = seen_[seenOf_[r] - 1];
    return (placeOf(scene_, seen.plane) - seen.place).squaredNorm() > seen.free * seen.free;
}

/// What contacts have moved goes back to where it is carried.
void SkinResponse::State::takeBack() {
    for (std::size_t b = 0; b < pushed_.size(); ++b) {
        if (pushed_[b] == 0) continue;
        pushed_[b] = 0;
        const std::size_t last = std::min((b + 1) * SkinRig::block, stirred_.size());
        for (std::size_t v = b * SkinRig::block; v < last; ++v) {
            scene_.skin[v] = scene_.carried[v];
            stirred_[v] = 0;
        }
    }
}

/// Which vertices contacts have moved from where they were carried to.
void SkinResponse::State::findStirred() {
    constexpr float still = settled * settled;
    for (std::size_t b = 0; b < pushed_.size(); ++b) {
        if (pushed_[b] == 0) continue;
        const std::size_t last = std::min((b + 1) * SkinRig::block, stirred_.size());
        for (std::size_t v = b * SkinRig::block; v < last; ++v)
            stirred_[v] = (scene_.skin[v] - scene_.carried[v]).squaredNorm() > still;
    }
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
    lacking_.assign(rig_->rows.size(), 0);
    float last = std::numeric_limits<float>::max();
    for (int round = 0; round < lookUps; ++round) {
        float lack = 0;
        for (std::uint32_t r = 0; r < rig_->rows.size(); ++r) {
            const SkinRow& row = rig_->rows[r];
            if (planeOf_[r] > 0) {
                SkinPlane& plane = planes_[planeOf_[r] - 1];
                lookAgain(*rig_, scene_, row, plane);
                lack = std::max(lack, -plane.gap);
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
        }
        if (found_.empty() && (lack <= settled || lack > progress * last)) break;
        last = lack;
        addDeepest();
        residual_ = rig_->size *
                    static_cast<double>(pushes_.solve(planes_, scene_.carried, rig_->parameters.iterations));
        takeBack();
        contacts_ = pushes_.apply(planes_, scene_.skin, pushed_);
        findStirred();
    }
}

/// Places of a block as they are now.
void SkinResponse::State::showPlaces(std::size_t block) {
    const std::size_t last = std::min((block + 1) * SkinRig::block, positions_.size());
    for (std::size_t v = block * SkinRig::block; v < last; ++v) {
        const Move& x = scene_.skin[v];
        turned_[v] = Move(x[1], x[2], x[0], 0);
        if (!rig_->parameters.faithful)
            positions_[v] = rig_->rest[v] + rig_->size * (x - rig_->places[v]).head<3>().cast<double>();
    }
}

void SkinResponse::State::showNormals(std::size_t block) {
    const std::size_t last = std::min((block + 1) * SkinRig::block, positions_.size());
    const Move *skin = scene_.skin.data(), *turned = turned_.data();
    const SkinFan* fan = rig_->fans.fans.data() + rig_->fans.start[block * SkinRig::block];
    for (std::size_t v = block * SkinRig::block; v < last; ++v) {
        Move sum = Move::Zero(); // z, x, y
        for (const SkinFan* end = rig_->fans.fans.data() + rig_->fans.start[v + 1]; fan != end; ++fan) {
            const Move spoke = skin[fan->middle] - skin[v], rim = skin[fan->last] - skin[fan->first];
            sum += spoke.cwiseProduct(turned[fan->last] - turned[fan->first]) -
                   (turned[fan->middle] - turned[v]).cwiseProduct(rim);
        }
        const float squared = sum.squaredNorm();
        const float scale = squared > 0 ? 1 / std::sqrt(squared) : 0;
        normals_[v] = scale > 0 ? Vec3((scale * Eigen::Vector3f(sum[1], sum[2], sum[0])).cast<double>())
                                : rig_->restNormals[v];
    }
}

/// What has moved, and the normals around it; all other skin is at rest.
void SkinResponse::State::show() {
    shownBefore_.swap(shown_);
    shown_.assign(rig_->blocks(), 0);
    for (std::size_t b = 0; b < shown_.size(); ++b)
        for (std::uint32_t k = rig_->aroundStart[b]; k < rig_->aroundStart[b + 1]; ++k)
            if (scene_.live[b] != 0 || pushed_[b] != 0) shown_[rig_->around[k]] = 1;
    for (std::size_t b = 0; b < shown_.size(); ++b)
        if (shown_[b] != 0 || shownBefore_[b] != 0) showPlaces(b);
    for (std::size_t b = 0; b < shown_.size(); ++b) {
        if (shown_[b] != 0) {
            showNormals(b);
        } else if (shownBefore_[b] != 0) {
            const auto first = static_cast<std::ptrdiff_t>(b * SkinRig::block);
            const auto count = std::min(SkinRig::block, normals_.size() - b * SkinRig::block);
            std::copy_n(rig_->restNormals.begin() + first, count, normals_.begin() + first);
        }
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
