#include "bake/respond/JointSlide.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss {

namespace {

/// Room kept above a threshold where a move ends, as a share of model.off: `advance` stops at a twentieth.
constexpr double endRoom = 0.1;

/// The way from q to the pose nearest to the goal where every near pair's linearised gap is at least
/// demand(near). False where there is none.
template <class Demand>
bool nearestWay(const JointModel& model, const JointValues& q, const JointValues& goal, double trust,
                JointWorkspace& ws, Demand demand, JointValues& way) {
    const int n = model.dofCount;
    ws.rows.clear(n);
    addLimits(model, q, trust, goal, ws.rows);
    const double distance = weightedDistance(model, q, goal);
    for (std::size_t i = 0; i < ws.nearCount; ++i) {
        const NearPair& near = ws.near[i];
        double* row = ws.rows.add();
        double squared = 0, bound = demand(near) - near.gap;
        for (int l = 0; l < n; ++l) {
            row[l] = near.gradient[l] * model.perWeight[l];
            squared += row[l] * row[l];
            bound -= near.gradient[l] * (goal[l] - q[l]);
        }
        const double length = std::sqrt(squared);
        // A gap that no DOF changes is no demand on them; nor is one met however far the way may go.
        if (length < 1e-9 || bound < (-1.5 * distance - model.off) * length) {
            ws.rows.dropLast();
            continue;
        }
        const double scale = 1 / length;
        for (int l = 0; l < n; ++l) row[l] *= scale;
        row[n] = bound * scale;
    }
    JointValues y;
    const double tolerance = 1e-13 * model.scale + 1e-3 * endRoom * model.off;
    if (!nearestToOrigin(ws.rows, tolerance, y)) return false;
    for (int l = 0; l < n; ++l) {
        const double end = goal[l] + y[l] * model.perWeight[l];
        way[l] = std::clamp(end, model.lower[l], model.upper[l]) - q[l];
    }
    return true;
}

double weightedLength(const JointModel& model, const JointValues& way) {
    double sum = 0;
    for (int l = 0; l < model.dofCount; ++l) sum += model.weights[l] * way[l] * model.weights[l] * way[l];
    return std::sqrt(sum);
}

/// Largest share of its range that any DOF goes.
double shareOfRange(const JointModel& model, const JointValues& way) {
    double share = 0;
    for (int l = 0; l < model.dofCount; ++l)
        if (model.upper[l] > model.lower[l])
            share = std::max(share, std::abs(way[l]) / (model.upper[l] - model.lower[l]));
    return share;
}

/// What each near pair needs above its threshold at the end of a way so that the bend of its gap does not
/// block the way: what the gap there lacks against the linear guess, and room for the bound that `advance`
/// must assume. Returns whether any demand of the first guess was too low.
bool findLifts(const JointModel& model, const JointValues& q, const JointValues& way, JointWorkspace& ws) {
    JointValues end = q;
    for (int l = 0; l < model.dofCount; ++l) end[l] += way[l];
    placeGroups(model, end, way, ws);
    bool short_ = false;
    Vec3 centre, normal;
    MotionBounds bounds;
    for (std::size_t i = 0; i < ws.nearCount; ++i) {
        NearPair& near = ws.near[i];
        const JointModel::Pair& pair = model.pairs[near.pair];
        double guess = near.gap;
        for (int l = 0; l < model.dofCount; ++l) guess += near.gradient[l] * way[l];
        const double real = pairGap(pair, ws.frames[pair.group].pose, centre, normal);
        bounds.bound(model, way, near);
        near.lift = endRoom * model.off + near.acceleration / 8 + std::max(0.0, guess - real);
        short_ = short_ || guess < near.threshold + near.lift;
    }
    return short_;
}

/// The way of one round of a slide; false where none goes on.
bool slideWay(const JointModel& model, const JointValues& q, const JointValues& goal, double trust,
              JointWorkspace& ws, JointValues& way) {
    for (std::size_t i = 0; i < ws.nearCount; ++i) ws.near[i].lift = endRoom * model.off;
    const auto lifted = [](const NearPair& near) { return near.threshold + near.lift; };
    // In a corner the lift cannot be had: where the pair is now is always feasible.
    const auto held = [](const NearPair& near) {
        return std::min(near.threshold + near.lift, std::max(near.threshold, near.gap));
    };
    if (!nearestWay(model, q, goal, trust, ws, lifted, way) &&
        !nearestWay(model, q, goal, trust, ws, held, way))
        return false;
    if (!findLifts(model, q, way, ws)) return true;
    JointValues second;
    if (nearestWay(model, q, goal, trust, ws, lifted, second) ||
        nearestWay(model, q, goal, trust, ws, held, second))
        way = second;
    return true;
}

} // namespace

void slide(const JointModel& model, const JointValues& goal, JointValues& q, JointWorkspace& ws) {
    double trust = 1;
    double distance = weightedDistance(model, q, goal);
    const double least = std::clamp(1e-3 * distance, 1e-7 * model.scale, 1e-5 * model.scale);
    for (int round = 0; round < 20 && distance > least; ++round) {
        JointValues way{};
        for (int l = 0; l < model.dofCount; ++l) way[l] = goal[l] - q[l];
        linearise(model, q, way, ws);
        // No pose from here on is farther from the goal than this one, so from this one than twice that.
        narrow(model, 2 * distance, ws);
        if (!slideWay(model, q, goal, trust, ws, way)) return;
        if (weightedLength(model, way) < least) return;
        // Pairs are known to be near only where a pose is no farther from the goal than this one.
        JointValues end = q, next = q;
        for (int l = 0; l < model.dofCount; ++l) end[l] += way[l];
        if (weightedDistance(model, end, goal) < distance) advance(model, way, next, ws);
        const double reached = weightedDistance(model, next, goal);
        if (reached < distance - 1e-3 * least) {
            q = next;
            distance = reached;
            trust = std::min(1.0, 2 * trust);
        } else {
            trust = 0.25 * std::min(trust, shareOfRange(model, way));
            if (trust < 1e-7) return;
        }
    }
}

double pushOut(const JointModel& model, JointValues& q, JointWorkspace& ws) {
    constexpr double trust = 0.25;
    JointValues reach{};
    for (int l = 0; l < model.dofCount; ++l) reach[l] = trust * (model.upper[l] - model.lower[l]);
    double depth = smallestGap(model, q, ws);
    ws.common = true;
    for (int round = 0; round < 40 && depth < 0.5 * model.off; ++round) {
        cull(model, q, reach, ws);
        JointValues way{};
        linearise(model, q, way, ws);
        double share = 1;
        const double missing = (1 + endRoom) * model.off - depth;
        while (!nearestWay(
            model, q, q, trust, ws, [&](const NearPair&) { return depth + share * missing; }, way)) {
            share *= 0.5;
            if (share < 1e-4) break;
        }
        if (share < 1e-4) break;
        for (std::size_t i = 0; i < ws.nearCount; ++i) ws.near[i].threshold = std::min(depth, model.off);
        JointValues end = q;
        double t = advance(model, way, end, ws);
        // The far end of the free way need not be the shallowest pose on it.
        double there = smallestGap(model, end, ws);
        for (int halving = 0; halving < 20 && there < depth + 0.25 * t * share * missing; ++halving) {
            t *= 0.5;
            for (int l = 0; l < model.dofCount; ++l) end[l] = q[l] + t * way[l];
            there = smallestGap(model, end, ws);
        }
        if (!(there > depth + 1e-6 * share * missing)) break;
        q = end;
        depth = there;
    }
    ws.common = false;
    return depth;
}

} // namespace tss
