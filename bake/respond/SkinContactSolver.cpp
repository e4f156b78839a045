#include "bake/respond/SkinContactSolver.h"

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

SkinContactSolver::SkinContactSolver(const SkinRig& rig)
    : rig_(rig), pushes_(rig), turnLimit_(rig), planeOf_(rig.rows.size(), 0), waitingOf_(rig.rows.size(), 0) {
    std::vector<std::vector<std::uint32_t>> rows(rig.blocks());
    for (std::uint32_t r = 0; r < rig.rows.size(); ++r)
        eachVertex(rig, rig.rows[r], [&](std::uint32_t v) {
            std::vector<std::uint32_t>& ofBlock = rows[v / SkinRig::block];
            if (ofBlock.empty() || ofBlock.back() != r) ofBlock.push_back(r);
        });
    blockRows_ = Lists<std::uint32_t>(rows);
}

bool SkinContactSolver::mayBeViolated(const SkinScene& scene, const Waiting& row) const {
    const auto displaced = [&](std::uint32_t v) { return pushes_.displaced(v); };
    if (row.free < 0) return true;
    return std::any_of(row.plane.vertex, row.plane.vertex + row.plane.vertices, displaced) &&
           (constrainedPoint(scene, row.plane) - row.plane.place).squaredNorm() > row.free * row.free;
}

/// Whether contacts have displaced any vertex of a row.
bool SkinContactSolver::displaced(const SkinRow& row) const {
    bool any = false;
    eachVertex(rig_, row, [&](std::uint32_t v) { any = any || pushes_.displaced(v); });
    return any;
}

/// Key by which addDeepest() groups violated rows: the node with the largest weight, the kind, and the body.
std::uint64_t SkinContactSolver::selectionKey(const SkinPlane& plane) const {
    const SkinFoundation& f = rig_.foundation;
    const SkinRow& row = rig_.rows[plane.row];
    const std::span<const SkinEntry> weights = f.weights[plane.vertex[0]];
    const auto most = std::ranges::max_element(weights, {}, &SkinEntry::value);
    const std::uint64_t node = weights.empty() ? f.nodes : most->index;
    return (node * 3 + static_cast<std::uint64_t>(row.kind)) * rig_.bodies.size() + row.body;
}

void SkinContactSolver::addPlane(const SkinPlane& plane) {
    planes_.push_back(plane);
    planeOf_[plane.row] = static_cast<std::uint32_t>(planes_.size());
}

/// Makes planes of the deepest violated row of each key. Pushes act through nodes, so that its push satisfies
/// most of the others too; those left over are queried again in the next round.
void SkinContactSolver::addDeepest() {
    std::ranges::sort(violated_, {}, [&](std::uint32_t w) {
        return std::tuple(waiting_[w].key, waiting_[w].plane.gap, waiting_[w].plane.row);
    });
    for (std::size_t k = 0; k < violated_.size(); ++k) {
        const Waiting& row = waiting_[violated_[k]];
        if (k == 0 || row.key != waiting_[violated_[k - 1]].key) addPlane(row.plane);
    }
    violated_.clear();
}

void SkinContactSolver::clear() {
    for (const SkinPlane& plane : planes_) planeOf_[plane.row] = 0;
    for (const Waiting& row : waiting_) waitingOf_[row.plane.row] = 0;
    planes_.clear();
    violated_.clear();
    waiting_.clear();
    pushes_.clear();
}

SkinPlane SkinContactSolver::timedQuery(const SkinScene& scene, std::uint32_t r) {
    const SkinRow& row = rig_.rows[r];
    if (clock.costs != nullptr) clock.charge(SkinPart::Sort);
    SkinPlane plane = queryContact(rig_, scene, row);
    plane.row = r;
    if (clock.costs == nullptr) return plane;
    const SkinPart body = rig_.bodies[row.body].bone() ? SkinPart::Bones : SkinPart::Muscles;
    clock.charge(row.kind == SkinContactKind::SkinOnSkin ? SkinPart::Folds : body);
    ++clock.costs->lookUps;
    return plane;
}

/// Queries a row that has no plane, and lets it wait.
void SkinContactSolver::query(const SkinScene& scene, std::uint32_t r) {
    SkinPlane plane = timedQuery(scene, r);
    plane.place = constrainedPoint(scene, plane);
    float free = unseen;
    if (plane.found) free = std::max(std::min(plane.gap, plane.distance - rig_.rows[r].offset) / 2, settled);
    // Of a vertex in a body another side may be the nearest at once.
    if (rig_.rows[r].insideAtRest) free = std::min(free, unseen);
    const bool violated = plane.found && plane.gap < 0;
    if (waitingOf_[r] == 0) {
        waiting_.emplace_back();
        waitingOf_[r] = static_cast<std::uint32_t>(waiting_.size());
    }
    waiting_[waitingOf_[r] - 1] = {plane, violated ? -1 : free, violated ? selectionKey(plane) : 0};
    if (violated) violated_.push_back(waitingOf_[r] - 1);
}

/// Updates all planes, and queries other rows where contacts have displaced the skin. Returns the largest
/// violation of the planes.
float SkinContactSolver::queryDisplaced(const SkinScene& scene) {
    const float slide = mostSlide * static_cast<float>(rig_.foundation.length);
    float lack = 0;
    for (std::size_t k = 0, count = planes_.size(); k < count; ++k) {
        const std::uint32_t r = planes_[k].row;
        if (planeOf_[r] != k + 1) continue; // replaced
        SkinPlane now = timedQuery(scene, r);
        const auto slid = [&] { return (now.place - constrainedPoint(scene, planes_[k])).norm() > slide; };
        if (now.found && now.gap < -settled && slid()) {
            now.push = drop(planes_[k]);
            addPlane(now);
        } else {
            updatePlane(now, scene, slide, planes_[k]);
        }
        lack = std::max(lack, -planes_[planeOf_[r] - 1].gap);
    }
    for (std::size_t k = 0, count = waiting_.size(); k < count; ++k) {
        const std::uint32_t r = waiting_[k].plane.row;
        if (planeOf_[r] == 0 && mayBeViolated(scene, waiting_[k])) query(scene, r);
    }
    for (std::size_t b = 0; b < blockRows_.size(); ++b) {
        if (!pushes_.reaches(b)) continue;
        for (const std::uint32_t r : blockRows_[b])
            if (waitingOf_[r] == 0 && displaced(rig_.rows[r]) && mayTouch(rig_, scene, rig_.rows[r]))
                query(scene, r);
    }
    clock.charge(SkinPart::Sort);
    return lack;
}

std::size_t SkinContactSolver::push(SkinScene& scene) {
    clear();
    for (std::uint32_t r = 0; r < rig_.rows.size(); ++r)
        if (mayTouch(rig_, scene, rig_.rows[r])) query(scene, r);
    clock.charge(SkinPart::Sort);
    if (violated_.empty()) return 0;
    float last = std::numeric_limits<float>::max(), least = last, before = last;
    best_.clear();
    for (int round = 1, stalled = 0;; ++round) {
        addDeepest();
        pushes_.solve(planes_, scene.carried, rig_.parameters.iterations);
        applied_ = planes_;
        std::size_t pushing = pushes_.apply(applied_, scene);
        clock.charge(SkinPart::Pushes);
        const float lack = queryDisplaced(scene);
        float now = lack;
        for (const std::uint32_t w : violated_) now = std::max(now, -waiting_[w].plane.gap);
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
        // Where bones press from two sides the last result may be worse than an earlier one.
        if (now > least) pushing = pushes_.apply(best_, scene);
        turnLimit_.limit(scene, pushes_);
        clock.charge(SkinPart::Pushes);
        return pushing;
    }
}

} // namespace tss
