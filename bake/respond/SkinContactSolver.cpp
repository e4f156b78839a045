#include "bake/respond/SkinContactSolver.h"

#include "bake/respond/SkinClearance.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace tss {
namespace {

/// Rounds of querying, solving and moving: where the skin has moved to there are new contacts, and the
/// normals of curved surfaces have changed. After so many there are as many more only where what is lacking
/// can be seen and these have halved it: in the crook of an elbow, between two bones, 24 were needed. Where
/// surfaces demand more than the skin can give, more would only press it flat.
constexpr int roundsAtATime = 8;

/// Rounds in a row that leave the planes violated no less: they demand more than the skin can give.
constexpr int mostStalled = 3;

/// Of the foundation's length: where a plane's point has slid along the skin by more, a push at its old place
/// hardly moves the new one, and the plane is replaced; and it tells nothing of what is met so far from where
/// it was found.
constexpr float mostSlide = 0.25f;

/// Makes a plane one that is never violated. Returns its push.
float drop(SkinPlane& plane) {
    plane.gap = std::numeric_limits<float>::max();
    plane.level = -1e6f;
    return std::exchange(plane.push, 0.0f);
}

/// Updates normal, gap and level of a plane by its row's latest query. Its vertices and weights stay, and so
/// does its push. A plane whose push has moved the two sides just clear of each other stays as it is, but for
/// where they have slid by `slide` since: without it they would touch again.
void updatePlane(const SkinPlane& now, const SkinScene& scene, float slide, SkinPlane& plane) {
    const Eigen::Vector3f place = constrainedPoint(scene, plane);
    const float slid = (place - plane.place).norm();
    // What is clear by more than it has slid along a surface has come past its edge.
    if (now.found && !(plane.push > 0 && now.gap > slid)) {
        plane.gap = now.gap;
        plane.normal = now.normal;
        plane.place = place;
        plane.level = plane.normal.dot(place) - plane.gap;
    } else if (plane.push > 0 && slid < slide) {
        plane.gap = 0;
    } else {
        drop(plane);
    }
}

/// Calls what(vertex) for each skin vertex of a row: its vertex and the corners of its first start.
template <class What>
void eachVertex(const SkinRig& rig, const SkinRow& row, const What& what) {
    if (row.kind != SkinContactKind::BodyOnSkin) what(row.vertex);
    if (row.kind != SkinContactKind::SkinOnBody)
        for (const int corner : rig.triangles[rig.starts[row.first]])
            what(static_cast<std::uint32_t>(corner));
}

} // namespace

SkinContactSolver::SkinContactSolver(const SkinRig& rig, SkinClock& clock)
    : rig_(rig), clock_(clock), pushes_(rig), turnLimit_(rig), planeOf_(rig.rows.size(), 0),
      waitingOf_(rig.rows.size(), 0) {
    std::vector<std::vector<std::uint32_t>> rows(rig.blocks());
    for (std::uint32_t r = 0; r < rig.rows.size(); ++r)
        eachVertex(rig, rig.rows[r], [&](std::uint32_t v) {
            std::vector<std::uint32_t>& ofBlock = rows[v / SkinRig::block];
            if (ofBlock.empty() || ofBlock.back() != r) ofBlock.push_back(r);
        });
    blockRows_ = Lists<std::uint32_t>(rows);
}

void SkinContactSolver::wait(std::uint32_t r, const Waiting& row) {
    if (waitingOf_[r] == 0) {
        waitingRows_.push_back(r);
        waitingOf_[r] = static_cast<std::uint32_t>(waitingRows_.size());
        waiting_.emplace_back();
    }
    waiting_[waitingOf_[r] - 1] = row;
}

/// Stores a row that is not violated; it need not be queried again before contacts have moved its point.
void SkinContactSolver::addSatisfied(const SkinScene& scene, std::uint32_t r, const SkinPlane& plane) {
    float free = unseen;
    if (plane.found) {
        const float clear = std::max(std::min(plane.gap, plane.distance - rig_.rows[r].offset) / 2, settled);
        // Of a vertex in a body another side may be the nearest at once.
        free = rig_.rows[r].insideAtRest ? std::min(clear, unseen) : clear;
    }
    wait(r, {plane, constrainedPoint(scene, plane), free});
}

bool SkinContactSolver::mayBeViolated(const SkinScene& scene, const Waiting& row) const {
    if (row.free < 0) return true;
    return displaced(row.plane) &&
           (constrainedPoint(scene, row.plane) - row.place).squaredNorm() > row.free * row.free;
}

/// Whether contacts have displaced any vertex of a plane.
bool SkinContactSolver::displaced(const SkinPlane& plane) const {
    bool any = false;
    for (int k = 0; k < plane.vertices; ++k) any = any || pushes_.displaced(plane.vertex[k]);
    return any;
}

bool SkinContactSolver::displaced(const SkinRow& row) const {
    bool any = false;
    eachVertex(rig_, row, [&](std::uint32_t v) { any = any || pushes_.displaced(v); });
    return any;
}

/// Key by which addDeepest() groups violated rows: the node with the largest weight, the kind, and the body.
std::uint64_t SkinContactSolver::selectionKey(const SkinRow& row, const SkinPlane& plane) const {
    const SkinFoundation& f = rig_.foundation;
    const std::span<const SkinEntry> weights = f.weights[plane.vertex[0]];
    const auto most = std::ranges::max_element(weights, {}, &SkinEntry::value);
    const std::uint64_t node = weights.empty() ? f.nodes : most->index;
    return (node * 3 + static_cast<std::uint64_t>(row.kind)) * rig_.bodies.size() + row.body;
}

void SkinContactSolver::addPlane(std::uint32_t r, const SkinPlane& plane) {
    rows_.push_back(r);
    planes_.push_back(plane);
    planeOf_[r] = static_cast<std::uint32_t>(planes_.size());
}

/// Makes planes of the deepest violated row of each key. Pushes act through nodes, so that its push satisfies
/// most of the others too; those left over are queried again in the next round.
void SkinContactSolver::addDeepest() {
    std::sort(violated_.begin(), violated_.end(), [](const Violated& a, const Violated& b) {
        return std::tie(a.key, a.plane.gap, a.row) < std::tie(b.key, b.plane.gap, b.row);
    });
    for (std::size_t k = 0; k < violated_.size(); ++k)
        if (k == 0 || violated_[k].key != violated_[k - 1].key)
            addPlane(violated_[k].row, violated_[k].plane);
    violated_.clear();
}

void SkinContactSolver::clear() {
    for (const std::uint32_t r : rows_) planeOf_[r] = 0;
    for (const std::uint32_t r : waitingRows_) waitingOf_[r] = 0;
    rows_.clear();
    waitingRows_.clear();
    planes_.clear();
    violated_.clear();
    waiting_.clear();
    pushes_.clear();
}

SkinPlane SkinContactSolver::timedQuery(const SkinScene& scene, const SkinRow& row) {
    if (clock_.costs == nullptr) return queryContact(rig_, scene, row);
    ++clock_.costs->lookUps;
    const SkinPart body = rig_.bodies[row.body].bone() ? SkinPart::Bones : SkinPart::Muscles;
    const SkinClock::Scope scope(clock_, row.kind == SkinContactKind::SkinOnSkin ? SkinPart::Folds : body);
    return queryContact(rig_, scene, row);
}

void SkinContactSolver::query(const SkinScene& scene, std::uint32_t r) {
    const SkinPlane plane = timedQuery(scene, rig_.rows[r]);
    if (!plane.found || plane.gap >= 0) return addSatisfied(scene, r, plane);
    violated_.push_back({selectionKey(rig_.rows[r], plane), r, plane});
    wait(r, {});
}

/// Queries all rows that may touch, with the skin as muscles and bones carry it.
void SkinContactSolver::queryAll(const SkinScene& scene) {
    const SkinClock::Scope scope(clock_, SkinPart::Sort);
    for (std::uint32_t r = 0; r < rig_.rows.size(); ++r)
        if (mayTouch(rig_, scene, rig_.rows[r])) query(scene, r);
}

/// The deepest violation of the rows in violated_.
float SkinContactSolver::deepestViolation() const {
    float deepest = 0;
    for (const Violated& one : violated_) deepest = std::max(deepest, -one.plane.gap);
    return deepest;
}

/// Updates all planes, and queries other rows where contacts have displaced the skin. Returns the largest
/// violation of the planes.
float SkinContactSolver::queryDisplaced(const SkinScene& scene) {
    const SkinClock::Scope scope(clock_, SkinPart::Sort);
    const float slide = mostSlide * static_cast<float>(rig_.foundation.length);
    float lack = 0;
    for (std::size_t k = 0, count = planes_.size(); k < count; ++k) {
        const std::uint32_t r = rows_[k];
        if (planeOf_[r] != k + 1) continue; // replaced
        SkinPlane now = timedQuery(scene, rig_.rows[r]);
        const auto slid = [&] { return (now.place - constrainedPoint(scene, planes_[k])).norm() > slide; };
        if (now.found && now.gap < -settled && slid()) {
            now.push = drop(planes_[k]);
            addPlane(r, now);
        } else {
            updatePlane(now, scene, slide, planes_[k]);
        }
        lack = std::max(lack, -planes_[planeOf_[r] - 1].gap);
    }
    for (std::size_t k = 0, count = waiting_.size(); k < count; ++k)
        if (planeOf_[waitingRows_[k]] == 0 && mayBeViolated(scene, waiting_[k]))
            query(scene, waitingRows_[k]);
    for (std::size_t b = 0; b < blockRows_.size(); ++b) {
        if (!pushes_.reaches(b)) continue;
        for (const std::uint32_t r : blockRows_[b])
            if (waitingOf_[r] == 0 && displaced(rig_.rows[r]) && mayTouch(rig_, scene, rig_.rows[r]))
                query(scene, r);
    }
    return lack;
}

std::size_t SkinContactSolver::push(SkinScene& scene) {
    clear();
    queryAll(scene);
    if (violated_.empty()) return 0;
    float last = std::numeric_limits<float>::max(), least = last, before = last;
    best_.clear();
    for (int round = 1, stalled = 0;; ++round) {
        std::size_t pushing = 0;
        {
            const SkinClock::Scope scope(clock_, SkinPart::Pushes);
            addDeepest();
            pushes_.solve(planes_, scene.carried, rig_.parameters.iterations);
            applied_ = planes_;
            pushing = pushes_.apply(applied_, scene);
        }
        const float lack = queryDisplaced(scene), now = std::max(lack, deepestViolation());
        if (now < least) {
            least = now;
            best_.swap(applied_);
        }
        stalled = lack < last ? 0 : stalled + 1;
        last = lack;
        const bool whole = round % roundsAtATime == 0;
        const bool more = !whole || (least > unseen && least <= before / 2);
        if (whole) before = least;
        if (more && (!violated_.empty() || (lack > settled && stalled < mostStalled))) continue;
        const SkinClock::Scope scope(clock_, SkinPart::Pushes);
        // Where bones press from two sides the last result may be worse than an earlier one.
        if (now > least) pushing = pushes_.apply(best_, scene);
        turnLimit_.limit(scene, pushes_);
        return pushing;
    }
}

} // namespace tss
