#include "bake/respond/SkinResistance.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace tss {
namespace {

/// Times that contacts are looked up, at most, after the first time where those before have moved the skin
/// to: new ones are met there, and planes of curved surfaces have turned.
constexpr int lookUps = 8;

/// Contacts that move the skin farther than this many times what the deepest lacks and a length of the
/// foundation have thrown it: a thrown place is in nothing any more, and seems to lack nothing.
constexpr float mostMove = 2;

/// Turns a plane to what its row meets now. What it pushes stays as it was first found, since it has hardly
/// slid, and so does its push.
void turnTo(const SkinPlane& now, const SkinScene& scene, SkinPlane& plane) {
    plane.gap = now.found ? now.gap : std::numeric_limits<float>::max();
    if (now.found) plane.normal = now.normal;
    plane.level = now.found ? plane.normal.dot(placeOf(scene, plane)) - plane.gap : -1e6f; // asks for nothing
}

/// Calls what(vertex) for each vertex of the skin that a row is about.
template <class What>
void eachVertex(const SkinRow& row, const What& what) {
    if (row.meeting != SkinMeeting::BodyOnSkin) what(row.vertex);
    if (row.meeting != SkinMeeting::SkinOnBody)
        for (const int corner : row.corners) what(static_cast<std::uint32_t>(corner));
}

} // namespace

SkinResistance::SkinResistance(const SkinRig& rig, SkinClock& clock)
    : rig_(rig), clock_(clock), pushes_(rig.foundation), planeOf_(rig.rows.size(), 0),
      seenOf_(rig.rows.size(), 0), pushed_(rig.blocks(), 0), stirred_(rig.places.size(), 0),
      asked_(rig.rows.size(), 0) {
    std::vector<std::vector<std::uint32_t>> rows(rig.blocks());
    for (std::uint32_t r = 0; r < rig.rows.size(); ++r)
        eachVertex(rig.rows[r], [&](std::uint32_t v) {
            std::vector<std::uint32_t>& ofBlock = rows[v / SkinRig::block];
            if (ofBlock.empty() || ofBlock.back() != r) ofBlock.push_back(r);
        });
    blockRows_ = Lists<std::uint32_t>(rows);
}

/// What a row that lacks nothing keeps until contacts have moved the skin there.
void SkinResistance::see(const SkinScene& scene, std::uint32_t r, const SkinPlane& plane) {
    if (seenOf_[r] == 0) {
        seenRows_.push_back(r);
        seenOf_[r] = static_cast<std::uint32_t>(seenRows_.size());
        seen_.emplace_back();
    }
    Seen& seen = seen_[seenOf_[r] - 1];
    seen.plane = plane;
    seen.free = unseen;
    if (plane.found)
        seen.free = std::max(std::min(plane.gap, plane.distance - rig_.rows[r].offset) / 2, settled);
    seen.place = placeOf(scene, seen.plane);
}

bool SkinResistance::moved(const SkinScene& scene, const Seen& seen) const {
    return (placeOf(scene, seen.plane) - seen.place).squaredNorm() > seen.free * seen.free;
}

bool SkinResistance::mayPush(const SkinScene& scene, std::uint32_t r) const {
    return seenOf_[r] == 0 ? mayMeet(rig_, scene, rig_.rows[r]) : moved(scene, seen_[seenOf_[r] - 1]);
}

/// What contacts have moved goes back to where it is carried.
void SkinResistance::takeBack(SkinScene& scene) {
    for (std::size_t b = 0; b < pushed_.size(); ++b) {
        if (pushed_[b] == 0) continue;
        pushed_[b] = 0;
        const std::size_t last = std::min((b + 1) * SkinRig::block, stirred_.size());
        for (std::size_t v = b * SkinRig::block; v < last; ++v) {
            scene.skin[v] = scene.carried[v];
            stirred_[v] = 0;
        }
    }
}

/// Which vertices contacts have moved from where they were carried to, and how far at most.
void SkinResistance::findStirred(const SkinScene& scene) {
    constexpr float still = settled * settled;
    float farthest = 0;
    for (std::size_t b = 0; b < pushed_.size(); ++b) {
        if (pushed_[b] == 0) continue;
        const std::size_t last = std::min((b + 1) * SkinRig::block, stirred_.size());
        const Move *skin = scene.skin.data(), *carried = scene.carried.data();
        char* stirred = stirred_.data();
        for (std::size_t v = b * SkinRig::block; v < last; ++v) {
            const float squared = (skin[v] - carried[v]).squaredNorm();
            stirred[v] = squared > still;
            farthest = std::max(farthest, squared);
        }
    }
    farthest_ = std::sqrt(farthest);
}

/// Whether that is so of any that a plane holds.
bool SkinResistance::stirred(const SkinPlane& plane) const {
    bool any = false;
    for (int k = 0; k < plane.vertices; ++k) any = any || stirred_[plane.vertex[k]];
    return any;
}

bool SkinResistance::stirred(const SkinRow& row) const {
    bool any = false;
    eachVertex(row, [&](std::uint32_t v) { any = any || stirred_[v]; });
    return any;
}

/// Where a plane is found for the choice of the deepest: the node that bears most on it, and what meets.
std::uint64_t SkinResistance::placeOfChoice(const SkinRow& row, const SkinPlane& plane) const {
    const SkinFoundation& f = rig_.foundation;
    const std::span<const SkinEntry> weights = f.weights[plane.vertex[0]];
    const auto most = std::ranges::max_element(weights, {}, &SkinEntry::value);
    const std::uint64_t node = weights.empty() ? f.nodes : most->index;
    return (node * 3 + static_cast<std::uint64_t>(row.meeting)) * rig_.bodies.size() + row.body;
}

/// Of the planes that were found, the deepest at each node and body: pushes act through nodes, so that most
/// of the others are met by it, and what is not is found again at the next look-up.
void SkinResistance::addDeepest() {
    std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) {
        return std::tie(a.place, a.plane.gap, a.row) < std::tie(b.place, b.plane.gap, b.row);
    });
    for (std::size_t k = 0; k < found_.size(); ++k) {
        const std::uint32_t r = found_[k].row;
        if (k > 0 && found_[k].place == found_[k - 1].place) {
            left_.push_back(r);
            isLeft_[r] = 1;
            continue;
        }
        rows_.push_back(r);
        planes_.push_back(found_[k].plane);
        planeOf_[r] = static_cast<std::uint32_t>(planes_.size());
    }
    found_.clear();
}

void SkinResistance::clear() {
    for (const std::uint32_t r : rows_) planeOf_[r] = 0;
    for (const std::uint32_t r : seenRows_) seenOf_[r] = 0;
    rows_.clear();
    seenRows_.clear();
    planes_.clear();
    found_.clear();
    seen_.clear();
    pushes_.clear();
    left_.clear();
    isLeft_.assign(rig_.rows.size(), 0);
}

SkinPlane SkinResistance::timedLookUp(const SkinScene& scene, const SkinRow& row) {
    if (clock_.costs == nullptr) return lookUp(rig_, scene, row);
    ++clock_.costs->lookUps;
    const SkinPart body = rig_.bodies[row.body].bone() ? SkinPart::Bones : SkinPart::Muscles;
    const SkinClock::Scope scope(clock_, row.meeting == SkinMeeting::SkinOnSkin ? SkinPart::Folds : body);
    return lookUp(rig_, scene, row);
}

void SkinResistance::lookAt(const SkinScene& scene, std::uint32_t r) {
    const SkinPlane plane = timedLookUp(scene, rig_.rows[r]);
    if (plane.found && plane.gap < 0)
        found_.push_back({placeOfChoice(rig_.rows[r], plane), r, plane});
    else
        see(scene, r, plane);
}

/// Fills found_ as the skin is carried.
void SkinResistance::lookUpFirst(const SkinScene& scene) {
    const SkinClock::Scope scope(clock_, SkinPart::Sort);
    for (std::uint32_t r = 0; r < rig_.rows.size(); ++r)
        if (mayMeet(rig_, scene, rig_.rows[r])) lookAt(scene, r);
}

/// What the deepest of the rows that were found lacks.
float SkinResistance::deepestFound() const {
    float deepest = 0;
    for (const Found& one : found_) deepest = std::max(deepest, -one.plane.gap);
    return deepest;
}

/// Turns the planes there are and fills found_, by what contacts have moved. Returns the most that one of the
/// planes lacks.
float SkinResistance::lookUpAgain(const SkinScene& scene) {
    const SkinClock::Scope scope(clock_, SkinPart::Sort);
    float lack = 0;
    for (std::size_t k = 0; k < planes_.size(); ++k) {
        turnTo(timedLookUp(scene, rig_.rows[rows_[k]]), scene, planes_[k]);
        lack = std::max(lack, -planes_[k].gap);
    }
    for (std::size_t k = 0, seen = seen_.size(); k < seen; ++k) {
        const std::uint32_t r = seenRows_[k];
        if (planeOf_[r] == 0 && isLeft_[r] == 0 && stirred(seen_[k].plane) && moved(scene, seen_[k]))
            lookAt(scene, r);
    }
    ++looks_;
    for (std::size_t b = 0; b < pushed_.size(); ++b) {
        if (pushed_[b] == 0) continue;
        for (const std::uint32_t r : blockRows_[b]) {
            if (asked_[r] == looks_) continue; // a row is about more than one block
            asked_[r] = looks_;
            if (planeOf_[r] == 0 && seenOf_[r] == 0 && isLeft_[r] == 0 && stirred(rig_.rows[r]) &&
                mayMeet(rig_, scene, rig_.rows[r]))
                lookAt(scene, r);
        }
    }
    std::erase_if(left_, [&](std::uint32_t r) {
        if (!mayPush(scene, r)) return false;
        isLeft_[r] = 0;
        lookAt(scene, r);
        return true;
    });
    return lack;
}

std::size_t SkinResistance::push(SkinScene& scene) {
    clear();
    lookUpFirst(scene);
    if (found_.empty()) return 0;
    const float deepest = deepestFound();
    const float mostMoved = mostMove * (deepest + static_cast<float>(rig_.foundation.length));
    float last = 0, least = std::numeric_limits<float>::max();
    best_.clear();
    for (int round = 1, stalled = 0;; ++round) {
        std::size_t pushing = 0;
        {
            const SkinClock::Scope scope(clock_, SkinPart::Pushes);
            addDeepest();
            pushes_.solve(planes_, scene.carried, deepest, rig_.parameters.iterations);
            applied_ = planes_;
            pushing = apply(scene, applied_);
        }
        const float lack = lookUpAgain(scene), now = std::max(lack, deepestFound());
        const bool thrown = farthest_ > mostMoved;
        if (!thrown && now < least) {
            least = now;
            best_.swap(applied_);
        }
        // What is twice no less deep than before is asked for more than the skin can give.
        stalled = lack < last ? 0 : stalled + 1;
        last = lack;
        if (round < lookUps && (!found_.empty() || (lack > settled && stalled < 2))) continue;
        // Bones that press skin from two sides may leave it thrown, or deeper than without any push.
        return thrown || now > deepest ? apply(scene, best_) : pushing;
    }
}

/// The skin as it is carried and pushed by these planes. Returns how many push.
std::size_t SkinResistance::apply(SkinScene& scene, std::span<const SkinPlane> planes) {
    takeBack(scene);
    const std::size_t pushing = pushes_.apply(planes, scene.skin, pushed_);
    findStirred(scene);
    return pushing;
}

} // namespace tss
