#include "bake/respond/JointSlide.h"

#include "bake/respond/JointClusters.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Margin above the threshold that the end of a move keeps, as a share of a pair's contact offset; advance()
/// stops at half of it.
constexpr double endRoom = 0.1;
/// A margin too small by less than this share of a pair's contact offset does not make a second solve worth
/// it.
constexpr double liftSlack = 0.04;
/// Trust region of the first round of a slide, as a share of each DOF's range.
constexpr double firstMove = 1.0 / 128;
/// Largest trust region of any round where groups are clustered, whose near pairs are listed for each way
/// anew.
constexpr double clusteredMove = 1.0 / 512;
/// Where more than `crowd` pairs come near on a way the trust region shrinks, but not below crowdedMove: a
/// round takes half a microsecond for each pair.
constexpr std::size_t crowd = 2000;
constexpr double crowdedMove = clusteredMove / 256;
/// Most solves of a round, each with the pairs that came near on the way found by the one before.
constexpr int mostListings = 8;
/// A slide ends where this many rounds reduced the distance to the goal by less than this share of it.
constexpr int stallRounds = 4;
constexpr double stallShare = 1e-4;
/// Share of a pair's lift beyond endRoom that it starts the next round with: ways get shorter, and their
/// curvature shrinks with the square.
constexpr double liftKept = 0.25;

/// The quadratic programme of one round of a slide at q: rows for limits, planes, and the linearised gap of
/// every near pair. A pair whose constraint cannot be active within reach gets no row.
class SlideRows {
public:
    SlideRows(const JointModel& model, const DofValues& q, const DofValues& goal, double trust,
              ResponseBuffers& ws)
        : model_(model), q_(q), goal_(goal), ws_(ws),
          least_(-1.5 * weightedDistance(model, q, goal) - model.leastContactOffset) {
        ws.rows.clear(model.dofCount);
        addLimits(model, q, trust, goal, ws.rows);
        addPairs(0);
    }

    /// Computes scale and offset of the rows of near pairs from index `first` on, which must be linearised.
    void addPairs(std::size_t first) {
        for (std::size_t i = first; i < ws_.nearCount; ++i) {
            NearPair& near = ws_.near[i];
            double squared = 0, offset = -near.gap;
            for (int l = 0; l < model_.dofCount; ++l) {
                const double part = near.gradient[l] * model_.perWeight[l];
                squared += part * part;
                offset -= near.gradient[l] * (goal_[l] - q_[l]);
            }
            near.row = -1;
            // A gap that no DOF changes cannot be constrained: no row.
            near.rowScale = squared >= 1e-18 ? 1 / std::sqrt(squared) : 0;
            near.rowOffset = offset * near.rowScale;
        }
    }

    /// Finds the step from q to the pose nearest to the goal at which every near pair's linearised gap is at
    /// least leastGap(near). False where there is none. Marks the groups whose rows are active in ws.held.
    template <class LeastGap>
    bool solve(LeastGap leastGap, DofValues& step) {
        for (std::size_t i = 0; i < ws_.nearCount; ++i) {
            NearPair& near = ws_.near[i];
            if (near.rowScale == 0) continue;
            const double bound = near.rowScale * leastGap(near) + near.rowOffset;
            if (near.row < 0 && bound < least_) continue; // met, however far the way may go
            if (near.row < 0) addRow(near);
            ws_.rows.setBound(near.row, bound);
        }
        DofValues y;
        const double tolerance = 1e-13 * model_.scale + 1e-3 * endRoom * model_.leastContactOffset;
        QpActive active;
        if (!nearestToOrigin(ws_.rows, tolerance, y, &active)) return false;
        mark(active);
        for (int l = 0; l < model_.dofCount; ++l) {
            const double end = goal_[l] + y[l] * model_.perWeight[l];
            step[l] = std::clamp(end, model_.lower[l], model_.upper[l]) - q_[l];
        }
        return true;
    }

private:
    void mark(const QpActive& active) {
        for (std::uint8_t& held : ws_.held) held &= static_cast<std::uint8_t>(~stoppedStep);
        for (std::size_t i = 0; i < ws_.nearCount && active.count > 0; ++i) {
            const NearPair& near = ws_.near[i];
            const auto end = active.rows.begin() + active.count;
            if (near.row >= 0 && std::find(active.rows.begin(), end, near.row) != end)
                ws_.held[model_.pairs[near.pair].group] |= stoppedStep;
        }
    }

    void addRow(NearPair& near) {
        near.row = ws_.rows.count();
        double* row = ws_.rows.add();
        for (int l = 0; l < model_.dofCount; ++l)
            row[l] = near.gradient[l] * model_.perWeight[l] * near.rowScale;
    }

    const JointModel& model_;
    const DofValues &q_, &goal_;
    ResponseBuffers& ws_;
    double least_; ///< rows with a bound below this are met within reach whatever the step
};

double weightedLength(const JointModel& model, const DofValues& step) {
    double sum = 0;
    for (int l = 0; l < model.dofCount; ++l) sum += model.weights[l] * step[l] * model.weights[l] * step[l];
    return std::sqrt(sum);
}

double leastLift(const JointModel& model, const NearPair& near) {
    return endRoom * model.contactOffset(near.pair);
}

enum class Ahead { Nothing, Listed, Crowded };

/// Lists the pairs of clustered groups that come near on a step from q, at most `most` of them, and adds
/// their rows.
Ahead listAhead(const JointModel& model, const DofValues& q, const DofValues& step, std::size_t most,
                SlideRows& rows, ResponseBuffers& ws) {
    if (!model.clustered) return Ahead::Nothing;
    const std::size_t first = ws.nearCount;
    if (!listOnStep(model, q, step, ws, most)) return Ahead::Crowded;
    if (ws.nearCount == first) return Ahead::Nothing;
    linearise(model, q, step, ws, first);
    for (std::size_t i = first; i < ws.nearCount; ++i) ws.near[i].lift = leastLift(model, ws.near[i]);
    rows.addPairs(first);
    return Ahead::Listed;
}

/// A step is found with linearised gaps, while advance() must assume the largest curvature. Sets the lift of
/// each near pair: how far above its threshold the linearised gap has to end for the step to be free, which
/// is by how much the true gap at the end is smaller, and by how far the curve may sag below its chord (an
/// eighth of the acceleration). Returns whether the step was found with less than that for some pair.
bool findLifts(const JointModel& model, const DofValues& q, const DofValues& step, ResponseBuffers& ws) {
    std::fill(ws.ended.begin(), ws.ended.end(), std::uint8_t(0));
    const auto placeEnd = [&](std::size_t g) {
        const JointModel::Group& group = model.groups[g];
        DofValues end;
        for (std::size_t k = 0; k < group.dofs.size(); ++k) end[k] = q[group.dofs[k]] + step[group.dofs[k]];
        ws.ends[g] = pose(group.motion, {end.data(), group.dofs.size()});
        ws.ended[g] = 1;
    };
    bool tooLow = false;
    Vec3 centre, normal;
    MotionBounds bounds;
    for (std::size_t i = 0; i < ws.nearCount; ++i) {
        NearPair& near = ws.near[i];
        const JointModel::Pair& pair = model.pairs[near.pair];
        if (!ws.ended[pair.group]) placeEnd(pair.group);
        double linear = near.gap;
        for (int l = 0; l < model.dofCount; ++l) linear += near.gradient[l] * step[l];
        const double real = pairGap(pair, ws.ends[pair.group], centre, normal);
        bounds.bound(model, step, near);
        const double contactOffset = model.groups[pair.group].contactOffset;
        near.lift = endRoom * contactOffset + near.acceleration / 8 + std::max(0.0, linear - real);
        tooLow = tooLow || linear < near.threshold + near.lift - liftSlack * contactOffset;
    }
    return tooLow;
}

enum class Way { None, Found, Crowded };

/// Finds the step of one round of a slide, with all pairs that come near on it listed. corner: set once no
/// step gives all pairs their lift.
Way slideStep(const JointModel& model, const DofValues& q, const DofValues& goal, double trust,
              ResponseBuffers& ws, bool& corner, DofValues& step) {
    const auto lifted = [](const NearPair& near) { return near.threshold + near.lift; };
    // In a corner a pair need not get farther than it is now, which is always feasible.
    const auto held = [](const NearPair& near) {
        return std::min(near.threshold + near.lift, std::max(near.threshold, near.gap));
    };
    SlideRows rows(model, q, goal, trust, ws);
    const std::size_t most = trust > crowdedMove ? crowd : ~std::size_t(0);
    const auto find = [&](DofValues& found) {
        for (int listing = 0; listing < mostListings; ++listing) {
            if (corner || !rows.solve(lifted, found)) {
                corner = true;
                if (!rows.solve(held, found)) return Way::None;
            }
            const Ahead ahead = listAhead(model, q, found, most, rows, ws);
            if (ahead == Ahead::Crowded) return Way::Crowded;
            if (ahead == Ahead::Nothing) break;
        }
        return Way::Found;
    };
    if (const Way way = find(step); way != Way::Found || !findLifts(model, q, step, ws)) return way;
    DofValues second;
    const Way way = find(second);
    if (way == Way::Found) step = second;
    return way == Way::Crowded ? way : Way::Found;
}

/// Removes the pairs of unclustered groups from the near list. Those of clustered groups stay, since what
/// came near on one way will on the next.
void keepClustered(const JointModel& model, ResponseBuffers& ws) {
    if (!model.clustered) return ws.clearNear();
    ws.removeNear(
        [&](const NearPair& near) { return !model.groups[model.pairs[near.pair].group].clustered; });
}

/// Culls for a round at q, `distance` from the goal. Returns true if the near list also serves all later
/// rounds, none of which is farther from the goal; otherwise it holds for moves up to `trust` of each range.
bool cullRound(const JointModel& model, const DofValues& q, double distance, double trust,
               ResponseBuffers& ws) {
    bool all = true;
    DofValues travel{};
    for (int l = 0; l < model.dofCount; ++l) {
        const double most = trust * model.range[l];
        travel[l] = 2 * distance * model.perWeight[l];
        if (travel[l] > most && most > 0) {
            travel[l] = most;
            all = false;
        }
    }
    keepClustered(model, ws);
    cullMore(model, q, travel, ws);
    return all;
}

} // namespace

void slide(const JointModel& model, const DofValues& goal, DofValues& q, ResponseBuffers& ws) {
    double trust = model.clustered ? clusteredMove : firstMove;
    double distance = weightedDistance(model, q, goal);
    const double least = std::clamp(1e-3 * distance, 1e-7 * model.scale, 1e-5 * model.scale);
    bool corner = false, complete = false;
    double before = distance; // some rounds ago
    for (int round = 0, far = 0; round < 20 && far < 40 && distance > least; ++(complete ? round : far)) {
        if (const int done = round + far; done > 0 && done % stallRounds == 0) {
            if (before - distance < stallShare * distance) return;
            before = distance;
        }
        if (!complete) {
            trust = std::min(trust, model.clustered ? clusteredMove : farMove);
            complete = cullRound(model, q, distance, trust, ws);
            if (complete && !model.clustered) trust = 1;
            for (std::size_t i = 0; i < ws.nearCount; ++i) ws.near[i].lift = leastLift(model, ws.near[i]);
        } else {
            for (std::size_t i = 0; i < ws.nearCount; ++i) {
                NearPair& near = ws.near[i];
                const double least = leastLift(model, near);
                near.lift = least + liftKept * (near.lift - least);
            }
        }
        DofValues step = partOfStep(model, q, goal, 1);
        linearise(model, q, step, ws);
        // No later pose is farther from the goal than this one, so none is farther from this one than twice
        // that.
        narrow(model, 2 * distance, ws);
        const Way way = slideStep(model, q, goal, trust, ws, corner, step);
        if (way == Way::None) return;
        if (way == Way::Crowded) {
            trust *= 0.25;
            ws.clearNear();
            continue;
        }
        if (weightedLength(model, step) < least) return;
        // The near list is complete only for poses no farther from the goal than this one.
        DofValues next = q;
        if (weightedDistance(model, along(model, q, step, 1), goal) < distance)
            advance(model, step, next, ws);
        const double reached = weightedDistance(model, next, goal);
        if (reached < distance - 1e-3 * least) {
            q = next;
            distance = reached;
            trust = std::min(model.clustered ? clusteredMove : 1.0, 2 * trust);
        } else {
            trust = 0.25 * std::min(trust, shareOfRange(model, step));
            if (trust < 1e-7) return;
        }
    }
}

double pushOut(const JointModel& model, DofValues& q, ResponseBuffers& ws) {
    constexpr double trust = 0.25;
    DofValues travel{};
    for (int l = 0; l < model.dofCount; ++l) travel[l] = trust * model.range[l];
    double depth = smallestLevel(model, q, ws);
    const auto gapAt = [&](const NearPair& near, double level) {
        return gapOf(model, model.contactOffset(near.pair), level);
    };
    ws.commonThreshold = true;
    for (int round = 0; round < 40 && depth < 0.5 * model.leastContactOffset; ++round) {
        cull(model, q, travel, ws);
        DofValues step{};
        listOnStep(model, q, step, ws);
        linearise(model, q, step, ws);
        double share = 1;
        const double missing = (1 + endRoom) * model.leastContactOffset - depth;
        SlideRows rows(model, q, q, trust, ws);
        const auto raised = [&](const NearPair& near) { return gapAt(near, depth + share * missing); };
        for (int listing = 0; listing < mostListings && share >= 1e-4; ++listing) {
            while (share >= 1e-4 && !rows.solve(raised, step)) share *= 0.5;
            if (share < 1e-4 || listAhead(model, q, step, ~std::size_t(0), rows, ws) == Ahead::Nothing) break;
        }
        if (share < 1e-4) break;
        for (std::size_t i = 0; i < ws.nearCount; ++i)
            ws.near[i].threshold = gapAt(ws.near[i], std::min(depth, model.leastContactOffset));
        DofValues end = q;
        double t = advance(model, step, end, ws);
        // The end of the free way need not be the least deep pose on it.
        double there = smallestLevel(model, end, ws);
        for (int halving = 0; halving < 20 && there < depth + 0.25 * t * share * missing; ++halving) {
            t *= 0.5;
            end = along(model, q, step, t);
            there = smallestLevel(model, end, ws);
        }
        if (!(there > depth + 1e-6 * share * missing)) break;
        q = end;
        depth = there;
    }
    ws.commonThreshold = false;
    return depth;
}

} // namespace tss
