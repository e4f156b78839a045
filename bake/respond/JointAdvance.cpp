#include "bake/respond/JointAdvance.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// A lower bound of the gap's rate just before and just beyond a row of some paths: for each DOF the smaller
/// of the two rates.
double lowestRate(const JointModel::Group& group, const MotionFrame& frame, const DofValues& step,
                  const Vec3& normal, const Vec3& centre) {
    double rate = 0;
    for (std::size_t k = 0; k < group.dofs.size(); ++k)
        rate += std::min(step[group.dofs[k]] * normal.dot(frame.twistsBeforeRow[k].velocity(centre)),
                         step[group.dofs[k]] * normal.dot(frame.twists[k].velocity(centre)));
    return rate;
}

/// Computes gap and rate of every active pair at q, and raises thresholds as gaps grow, up to the contact
/// offset.
void updateGaps(const JointModel& model, const DofValues& q, const DofValues& step, std::size_t activeCount,
                ResponseBuffers& ws) {
    std::uint32_t at = ~0u;
    DofTwist whole;
    for (std::size_t i = 0; i < activeCount; ++i) {
        NearPair& near = ws.near[ws.active[i]];
        const JointModel::Pair& pair = model.pairs[near.pair];
        const MotionFrame& frame = ws.groups[pair.group].frame;
        if (pair.group != at) {
            at = pair.group;
            placeGroup(model, at, q, step, ws);
            whole = twistOfStep(model.groups[at], frame, step);
        }
        Vec3 centre, normal;
        near.gap = pairGap(pair, frame.pose, centre, normal);
        near.rate = normal.dot(whole.velocity(centre));
        if (frame.rowAhead) near.rate = lowestRate(model.groups[at], frame, step, normal, centre);
        if (!ws.commonThreshold)
            near.threshold =
                std::max(near.threshold, std::min(model.groups[pair.group].contactOffset, near.gap));
    }
}

/// Time until a gap g >= 0 can close that changes at `rate`, while the rate falls by at most `acceleration`
/// per unit of time: the positive root of g + rate t - acceleration t^2 / 2, written without cancellation. A
/// time of 1 or more, beyond the end of the way, is returned as HUGE_VAL.
double closingTime(double g, double rate, double acceleration) {
    const double root = std::sqrt(rate * rate + 2 * acceleration * g);
    if (rate <= 0) {
        const double falls = root - rate;
        if (falls == 0 && acceleration > 0) return 0; // no room at all, and the rate is about to fall below 0
        return 2 * g < falls ? 2 * g / falls : HUGE_VAL;
    }
    return rate + root < acceleration ? (rate + root) / acceleration : HUGE_VAL;
}

/// Time until some path DOF reaches its next row, where its rate jumps.
double timeToRow(const JointModel::Group& group, const DofValues& q, const DofValues& step) {
    double time = HUGE_VAL;
    if (!group.paths) return time;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        const int l = group.dofs[k];
        const double left = std::abs(nextRow(group.motion.dofs[k], q[l], step[l]) - q[l]);
        if (left < std::abs(step[l])) time = std::min(time, left / std::abs(step[l]));
    }
    return time;
}

/// A time, at most `left`, during which no active pair can reach its threshold; 0 when one is there already.
double safeTime(const JointModel& model, const DofValues& q, const DofValues& step, double left,
                std::size_t activeCount, ResponseBuffers& ws) {
    double time = left;
    std::uint32_t at = ~0u;
    double row = HUGE_VAL;
    for (std::size_t i = 0; i < activeCount; ++i) {
        const NearPair& near = ws.near[ws.active[i]];
        const double room = near.gap - near.threshold;
        if (time > 0 && near.speed * time < room) continue;
        const JointModel::Pair& pair = model.pairs[near.pair];
        const bool closes = near.rate < 0 || (near.rate == 0 && near.acceleration > 0 && room <= 0);
        if (closes && room < 0.05 * model.groups[pair.group].contactOffset) {
            ws.held[pair.group] |= stoppedStep;
            time = 0; // no early exit: all groups that stop the way are to be marked
        }
        if (time == 0) continue;
        if (const std::uint32_t group = pair.group; group != at) {
            at = group;
            row = timeToRow(model.groups[group], q, step);
        }
        const double g = std::max(room, 0.0);
        const double first = near.speed > 0 ? g / near.speed : HUGE_VAL;
        const double second = std::min(closingTime(g, near.rate, near.acceleration), row);
        time = std::min(time, std::max(first, second) * (1 - 1e-7));
    }
    return time;
}

} // namespace

DofTwist twistOfStep(const JointModel::Group& group, const MotionFrame& frame, const DofValues& step) {
    DofTwist whole;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        whole.turn += step[group.dofs[k]] * frame.twists[k].turn;
        whole.slide += step[group.dofs[k]] * frame.twists[k].slide;
    }
    return whole;
}

void MotionBounds::bound(const JointModel& model, const DofValues& step, NearPair& near) {
    if (const std::uint32_t index = model.pairs[near.pair].group; index != group_) {
        group_ = index;
        const JointModel::Group& group = model.groups[index];
        count_ = static_cast<int>(group.dofs.size());
        double turning = 0; // by the DOFs nearer to A
        for (int k = 0; k < count_; ++k) {
            dofs_[k] = group.dofs[k];
            change_[k] = std::abs(step[dofs_[k]]);
            const double turn = group.turnRates[k] * change_[k];
            bend_[k] = change_[k] * (turn + 2 * turning);
            turning += turn;
        }
    }
    const double* speed = model.speed(near.pair);
    near.speed = near.acceleration = 0;
    for (int k = 0; k < count_; ++k) {
        near.speed += speed[dofs_[k]] * change_[k];
        near.acceleration += speed[dofs_[k]] * bend_[k];
    }
}

double advance(const JointModel& model, const DofValues& step, DofValues& q, ResponseBuffers& ws) {
    const DofValues start = q;
    std::size_t activeCount = 0;
    if (ws.active.size() < ws.nearCount) ws.active.resize(ws.near.size());
    MotionBounds bounds;
    for (std::size_t i = 0; i < ws.nearCount; ++i) {
        NearPair& near = ws.near[i];
        bounds.bound(model, step, near);
        if (near.gap - near.threshold <= near.speed) ws.active[activeCount++] = static_cast<std::uint32_t>(i);
    }
    if (activeCount == 0) {
        q = along(model, start, step, 1);
        return 1;
    }
    double t = 0;
    for (int round = 0; round < 60 && t < 1; ++round) {
        updateGaps(model, q, step, activeCount, ws);
        const double share = safeTime(model, q, step, 1 - t, activeCount, ws);
        if (share <= 1e-13) break;
        t = share >= 1 - t ? 1 : t + share;
        q = along(model, start, step, t);
    }
    return t;
}

} // namespace tss
