#include "bake/respond/NearTests.h"

#include "bake/respond/JointAdvance.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// By how much the gap of a pair may have changed from one pose to another.
double changeBetween(const JointModel::Group& group, const Pose& from, const Pose& to) {
    return ((from * group.middle - to * group.middle).norm() +
            (from.linear() - to.linear()).norm() * group.spread) *
           (1 + hair);
}

std::uint32_t binOf(const KnownNear& known, double gap) {
    const double bin = gap / known.range * KnownNear::bins;
    return bin > 0 ? std::min(static_cast<std::uint32_t>(std::min(bin, 1e6)), KnownNear::bins - 1) : 0;
}

/// Keeps the tests found where the group stands, by their gaps.
void remember(const JointModel& model, const JointModel::Group& group, const Pose& pose, double range,
              std::span<const std::uint32_t> found, KnownNear& known) {
    known.range = known.least = range;
    known.pose = pose;
    std::array<std::uint8_t, KnownNear::most> bins;
    std::array<std::uint32_t, KnownNear::bins + 1> counts{};
    Vec3 centre, normal;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double gap = pairGap(model.pairs[group.firstPair + found[i]], pose, centre, normal);
        known.least = std::min(known.least, gap);
        bins[i] = static_cast<std::uint8_t>(binOf(known, gap));
        ++counts[bins[i] + 1u];
    }
    for (std::uint32_t bin = 0; bin < KnownNear::bins; ++bin) counts[bin + 1] += counts[bin];
    for (std::size_t i = 0; i < found.size(); ++i) known.tests[counts[bins[i]]++] = found[i];
    std::copy_n(counts.begin(), KnownNear::bins, known.ends.begin());
}

void rememberClear(const JointModel::Group& group, const DofValues& q, const MotionFrame& frame, double clear,
                   KnownNear& known) {
    known.clear = clear;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) known.values[k] = q[group.dofs[k]];
    known.frame.pose = frame.pose;
    std::copy_n(frame.twists.begin(), group.dofs.size(), known.frame.twists.begin());
}

} // namespace

std::span<const std::uint32_t> testsNear(const JointModel& model, std::size_t g, const DofValues& q,
                                         double margin, std::uint32_t enough, ResponseRoom& ws) {
    const JointModel::Group& group = model.groups[g];
    const MotionFrame& frame = ws.groups[g].frame;
    KnownNear& known = ws.known[g];
    const auto nearest = [&](double gap) {
        return std::span<const std::uint32_t>(known.tests.data(), known.ends[binOf(known, gap)]);
    };
    const double change = changeBetween(group, known.pose, frame.pose);
    if (margin + change <= known.range) {
        rememberClear(group, q, frame, known.least - change, known);
        return nearest(margin + change);
    }
    if (known.more == 0) known.more = group.spread / 16;
    const auto find = [&](double within, std::uint32_t most) {
        return group.tree->testsWithin(frame.pose, within, most, ws.found.data());
    };
    std::uint32_t found = find(margin + known.more, KnownNear::most);
    if (found <= KnownNear::most) {
        remember(model, group, frame.pose, margin + known.more, {ws.found.data(), found}, known);
        rememberClear(group, q, frame, known.least, known);
        if (found < KnownNear::most / 4) known.more = std::min(2 * known.more, 16 * group.spread);
        return nearest(margin);
    }
    known.more = std::max(0.5 * known.more, group.spread / 1024);
    found = find(margin, enough);
    return {ws.found.data(), found};
}

Closing closingOf(const JointModel::Group& group, const DofValues& step) {
    Closing closing;
    double turning = 0, acceleration = 0;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        const double change = std::abs(step[group.dofs[k]]), turn = group.turnRates[k] * change;
        closing.most += group.fastest[k] * change;
        acceleration += group.fastest[k] * change * (turn + 2 * turning);
        turning += turn;
    }
    // The rate of a path jumps at its rows.
    closing.bend = group.paths ? std::numeric_limits<double>::infinity() : 0.5 * acceleration;
    return closing;
}

double fastestRate(const JointModel::Group& group, const MotionFrame& frame, const DofTwist& whole) {
    return whole.velocity(frame.pose * group.middle).norm() + whole.turn.norm() * group.spread;
}

bool stillClear(const JointModel& model, std::size_t g, const DofValues& q, const DofValues& step,
                const ResponseRoom& ws) {
    const JointModel::Group& group = model.groups[g];
    const KnownNear& known = ws.known[g];
    const double room = known.clear - keptFrom(group);
    if (!(room > 0)) return false;
    // Whatever it passes lies straight ahead of where it was, no farther than the ends.
    DofValues first{}, last{}, farther{};
    bool moved = false;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        const int l = group.dofs[k];
        first[l] = q[l] - known.values[k];
        last[l] = first[l] + step[l];
        farther[l] = std::max(std::abs(first[l]), std::abs(last[l]));
        moved = moved || first[l] != 0;
    }
    const Closing closing = closingOf(group, farther);
    if (closing.most * (1 + hair) < room) return true;
    const auto rate = [&](const DofValues& way) {
        return fastestRate(group, known.frame, twistOfStep(group, known.frame, way));
    };
    const double fastest = moved ? std::max(rate(first), rate(last)) : rate(last);
    return (fastest + closing.bend) * (1 + hair) < room;
}

} // namespace tss
