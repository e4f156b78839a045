#include "bake/respond/JointResponder.h"

#include "bake/base/Order.h"
#include "bake/motion/WholeTurn.h"
#include "bake/respond/JointClusters.h"
#include "bake/respond/JointModel.h"
#include "bake/respond/JointSlide.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// How far a joint moves towards its free pose in one response, as a share of the limits' diagonal.
constexpr double returnShare = 0.05;

TableOnJoint wholeJoint(const Table& table) {
    return {&table, indicesOf<int>(table.motion.dofCount())};
}

/// Of a model with clustered groups: a leg is shortened until at most manyNear pairs come near on it, or
/// until no DOF moves by more than leastLeg of its range. The first leg moves none by more than firstLeg.
constexpr std::size_t manyNear = 128;
constexpr double leastLeg = 1.0 / 4096, firstLeg = 1.0 / 256;

/// The way from a pose to the goal is divided into legs, so that few pairs are near each of them.
struct Legs {
    int count = 1;    ///< without clustered groups: how many equal legs are left
    double share = 1; ///< with clustered groups: the share of the rest of the way that the next leg covers
};

int equalLegs(const JointModel& model, const DofValues& start, const DofValues& goal) {
    double legs = 1;
    for (int l = 0; l < model.dofCount; ++l) {
        const double most = farMove * model.range[l];
        if (most > 0) legs = std::max(legs, std::ceil(std::abs(goal[l] - start[l]) / most));
    }
    return static_cast<int>(legs);
}

/// Lists the pairs near the first of `legs` equal legs from q to the goal.
void cullLeg(const JointModel& model, const DofValues& q, const DofValues& goal, int legs,
             ResponseBuffers& ws) {
    DofValues travel{};
    for (int l = 0; l < model.dofCount; ++l) travel[l] = std::abs(goal[l] - q[l]) / legs;
    cull(model, q, travel, ws);
}

/// Lists the pairs near the first part of the way, chosen so that they are few and no DOF moves by more than
/// `most` of its range. Returns which share of the way that part is.
double cullAhead(const JointModel& model, const DofValues& q, const DofValues& goal, double most,
                 ResponseBuffers& ws) {
    const double whole = shareOfRange(model, partOfStep(model, q, goal, 1));
    for (double share = whole > most ? most / whole : 1;; share *= 0.25) {
        const DofValues step = partOfStep(model, q, goal, share);
        DofValues travel{};
        for (int l = 0; l < model.dofCount; ++l) travel[l] = std::abs(step[l]);
        cull(model, q, travel, ws);
        const bool last = share * whole <= leastLeg;
        if (listOnStep(model, q, step, ws, last ? ~std::size_t(0) : manyNear)) return share;
    }
}

Legs beginLegs(const JointModel& model, const DofValues& q, const DofValues& goal, ResponseBuffers& ws) {
    Legs legs;
    if (model.clustered) {
        legs.share = cullAhead(model, q, goal, firstLeg, ws);
        legs.count = legs.share < 1 ? 2 : 1;
    } else {
        legs.count = equalLegs(model, q, goal);
        cullLeg(model, q, goal, legs.count, ws);
    }
    return legs;
}

/// Goes from q to the goal, leg by leg, as far as the way is free. Before, ws holds the near pairs of the
/// first leg; after, those of the last leg that was begun. False where the way is not free to the end.
bool walk(const JointModel& model, const DofValues& goal, Legs legs, DofValues& q, ResponseBuffers& ws) {
    if (model.clustered) {
        while (legs.share < 1) {
            const DofValues step = partOfStep(model, q, goal, legs.share);
            if (advance(model, step, q, ws) < 1) return false;
            const double most = 4 * shareOfRange(model, step);
            legs.share = cullAhead(model, q, goal, std::min(most, farMove), ws);
        }
        legs.count = 1;
    }
    DofValues step{};
    for (; legs.count > 0; --legs.count) {
        for (int l = 0; l < model.dofCount; ++l) step[l] = (goal[l] - q[l]) / legs.count;
        if (advance(model, step, q, ws) < 1) return false;
        if (legs.count > 1) cullLeg(model, q, goal, legs.count - 1, ws);
    }
    q = goal;
    return true;
}

} // namespace

/// The implementation of a responder.
class JointResponder::Prepared {
public:
    Prepared(std::span<const TableOnJoint> tables, int dofCount);
    JointAnswer respond(const double* last, const double* asked, ResponseBuffers& ws) const;
    const JointModel& model() const { return model_; }
    const DofValues* freePose() const { return hasFreePose_ ? &freePose_ : nullptr; }

private:
    void findFreePose();
    JointAnswer respondWithinLimits(const DofValues& start, const DofValues& goal, ResponseBuffers& ws) const;
    JointAnswer fromFree(const DofValues& start, const DofValues& goal, Legs legs, ResponseBuffers& ws) const;
    JointAnswer fromCollision(const DofValues& start, const DofValues& goal, double depth,
                              ResponseBuffers& ws) const;
    JointAnswer answerAt(const DofValues& q, JointStatus status, ResponseBuffers& ws) const;

    JointModel model_;
    DofValues freePose_{};
    bool hasFreePose_ = false;
    double knownDepth_ = 0; ///< least gapDepth of the tables
};

JointResponder::Prepared::Prepared(std::span<const TableOnJoint> tables, int dofCount)
    : model_(makeJointModel(tables, dofCount)) {
    knownDepth_ = infinity;
    for (const TableOnJoint& entry : tables) knownDepth_ = std::min(knownDepth_, entry.table->gapDepth);
    findFreePose();
}

void JointResponder::Prepared::findFreePose() {
    ResponseBuffers ws = buffersFor(model_);
    freePose_ = clampToLimits(model_, model_.rest.data(), ws);
    double best = smallestLevel(model_, freePose_, ws);
    // A grid of at most some thousand poses, limits included.
    const int n = model_.dofCount;
    const int side = n == 0 ? 1 : std::max(2, static_cast<int>(std::pow(1000.0, 1.0 / n)));
    long count = 1;
    for (int l = 0; l < n && count < 5000; ++l) count *= side;
    for (long i = 0; i < count && best <= 2 * model_.leastContactOffset; ++i) {
        DofValues q{};
        long digits = i;
        for (int l = 0; l < n; ++l, digits /= side)
            q[l] = model_.first[l] + model_.range[l] * double(digits % side) / std::max(1, side - 1);
        q = clampToLimits(model_, q.data(), ws);
        const double gap = smallestLevel(model_, q, ws);
        if (gap > best) {
            best = gap;
            freePose_ = q;
        }
    }
    hasFreePose_ = best > 0;
}

JointAnswer JointResponder::Prepared::answerAt(const DofValues& q, JointStatus status,
                                               ResponseBuffers& ws) const {
    JointAnswer answer;
    answer.q = q;
    answer.status = status;
    answer.gap = infinity;
    std::uint32_t at = ~0u;
    Pose inverse = Pose::Identity();
    for (std::size_t i = 0; i < ws.nearCount; ++i) {
        const JointModel::Pair& pair = model_.pairs[ws.near[i].pair];
        if (pair.group != at) {
            at = pair.group;
            placeGroup(model_, at, q, q, ws);
            inverse = ws.groups[at].frame.pose.inverse(Eigen::Isometry);
        }
        const JointModel::Group& group = model_.groups[at];
        const std::uint32_t test = ws.near[i].pair - group.firstPair;
        const double gap = queryGap(*group.tests, test, inverse);
        if (gap < answer.gap) {
            answer.gap = gap;
            answer.table = static_cast<int>(at);
            answer.test = static_cast<int>(test);
        }
    }
    return answer;
}

JointAnswer JointResponder::Prepared::fromFree(const DofValues& start, const DofValues& goal, Legs legs,
                                               ResponseBuffers& ws) const {
    DofValues q = start;
    if (walk(model_, goal, legs, q, ws)) {
        const JointAnswer free = answerAt(q, JointStatus::Free, ws);
        if (free.gap > 0) return free;
        q = start;
    }
    const double before = weightedDistance(model_, q, goal);
    for (std::uint8_t& held : ws.held)
        if (held & stoppedStep) held |= passedBy;
    slide(model_, goal, q, ws);
    if (std::any_of(ws.held.begin(), ws.held.end(), [](std::uint8_t held) { return held & stoppedStep; }))
        for (std::uint8_t& held : ws.held) held &= static_cast<std::uint8_t>(~passedBy);
    const double after = weightedDistance(model_, q, goal);
    const bool slid = after < before - 1e-6 * model_.scale;
    JointAnswer answer = answerAt(q, slid ? JointStatus::Slid : JointStatus::Blocked, ws);
    // Rounding must not break the promise of JointResponder: then the joint stays at the start.
    if (!(answer.gap > 0) || !(after <= weightedDistance(model_, start, goal)))
        answer = answerAt(start, JointStatus::Blocked, ws);
    return answer;
}

JointAnswer JointResponder::Prepared::fromCollision(const DofValues& start, const DofValues& goal,
                                                    double depth, ResponseBuffers& ws) const {
    DofValues q = start;
    const bool deep = knownDepth_ > 0 && depth < -knownDepth_ && hasFreePose_;
    const double pushed = deep ? depth : pushOut(model_, q, ws);
    if (pushed > 0) {
        const Legs legs = beginLegs(model_, q, goal, ws);
        JointAnswer answer = fromFree(q, goal, legs, ws);
        answer.status = JointStatus::Separated;
        if (answer.gap > 0) return answer;
    }
    // A smaller improvement is rounding.
    JointStatus status =
        pushed > depth + 1e-3 * model_.leastContactOffset ? JointStatus::Separated : JointStatus::Stuck;
    if (hasFreePose_) {
        // From the start, not from where pushOut() ended, which the next response would be pushed back to.
        DofValues free = freePose_;
        for (int l = 0; l < model_.dofCount; ++l)
            if (model_.periodic[l]) free[l] = nearestTurn(free[l], start[l]);
        const double far = weightedDistance(model_, start, free);
        const double t = far > 0 ? std::min(1.0, returnShare * model_.scale / far) : 1;
        q = t == 1 ? free : along(model_, start, partOfStep(model_, start, free, 1), t);
        status = JointStatus::Returning;
    }
    cull(model_, q, model_.range, ws);
    listOnStep(model_, q, DofValues{}, ws);
    JointAnswer answer = answerAt(q, status, ws);
    if (answer.gap > 0) answer.status = JointStatus::Separated;
    return answer;
}

JointAnswer JointResponder::Prepared::respond(const double* last, const double* asked,
                                              ResponseBuffers& ws) const {
    for (PlacedGroup& group : ws.groups) group.valid = false; // the workspace may have served another joint
    for (PlacedChain& chain : ws.chains) chain.count = 0;
    std::fill(ws.held.begin(), ws.held.end(), std::uint8_t(0));
    if (model_.clustered && ws.cachesOf != model_.id) {
        for (NearCache& cache : ws.caches) cache.clear();
        ws.cachesOf = model_.id;
    }
    DofValues from{}, to{};
    std::copy_n(last, model_.dofCount, from.begin());
    std::copy_n(asked, model_.dofCount, to.begin());
    wrapTurns(model_, from);
    for (int l = 0; l < model_.dofCount; ++l) {
        if (!std::isfinite(to[l])) to[l] = from[l];
        if (model_.periodic[l]) to[l] = nearestTurn(to[l], from[l]);
    }
    JointAnswer answer =
        respondWithinLimits(clampToLimits(model_, from.data(), ws), clampToLimits(model_, to.data(), ws), ws);
    wrapTurns(model_, answer.q);
    return answer;
}

JointAnswer JointResponder::Prepared::respondWithinLimits(const DofValues& start, const DofValues& goal,
                                                          ResponseBuffers& ws) const {
    ws.commonThreshold = false;
    const Legs legs = beginLegs(model_, start, goal, ws);
    if (legs.count == 1 && ws.nearCount == 0) {
        JointAnswer free;
        free.q = goal;
        free.gap = infinity;
        return free;
    }
    double gap = infinity;
    for (std::size_t i = 0; i < ws.nearCount; ++i) gap = std::min(gap, ws.near[i].gap);
    // So close to 0 that rounding decides the sign, the arithmetic of the exact query counts.
    const double deepest = std::max(gap, 0.0);
    if (std::abs(gap) < 0.5 * model_.leastContactOffset) gap = answerAt(start, JointStatus::Free, ws).gap;
    if (gap > 0) return fromFree(start, goal, legs, ws);
    for (std::size_t i = 0; i < ws.nearCount; ++i)
        if (ws.near[i].gap <= deepest) ws.held[model_.pairs[ws.near[i].pair].group] = touchedAtStart;
    return fromCollision(start, goal, gap, ws);
}

JointWorkspace::JointWorkspace(std::unique_ptr<ResponseBuffers> room) : room_(std::move(room)) {}
JointWorkspace::JointWorkspace(JointWorkspace&&) noexcept = default;
JointWorkspace& JointWorkspace::operator=(JointWorkspace&&) noexcept = default;
JointWorkspace::~JointWorkspace() = default;

std::span<const std::uint8_t> JointWorkspace::held() const {
    return room_->held;
}

JointResponder::JointResponder(const Table& table)
    : JointResponder(std::vector<TableOnJoint>{wholeJoint(table)},
                     static_cast<int>(table.motion.dofCount())) {}

JointResponder::JointResponder(std::span<const TableOnJoint> tables, int dofCount)
    : prepared_(std::make_unique<const Prepared>(tables, dofCount)) {}

JointResponder::JointResponder(JointResponder&&) noexcept = default;
JointResponder& JointResponder::operator=(JointResponder&&) noexcept = default;
JointResponder::~JointResponder() = default;

JointWorkspace JointResponder::workspace() const {
    return JointWorkspace(std::make_unique<ResponseBuffers>(buffersFor(prepared_->model())));
}

JointAnswer JointResponder::respond(const double* last, const double* asked,
                                    JointWorkspace& workspace) const {
    return prepared_->respond(last, asked, *workspace.room_);
}

QueryResult JointResponder::nearest(std::size_t table, const double* q, JointWorkspace& workspace) const {
    DofValues values{};
    std::copy_n(q, dofCount(), values.begin());
    return nearestTest(prepared_->model(), table, values, *workspace.room_);
}

int JointResponder::dofCount() const {
    return prepared_->model().dofCount;
}

const DofValues& JointResponder::weights() const {
    return prepared_->model().weights;
}

double JointResponder::keptGap(std::size_t table) const {
    return prepared_->model().groups[table].contactOffset;
}

const DofValues* JointResponder::freePose() const {
    return prepared_->freePose();
}

} // namespace tss
