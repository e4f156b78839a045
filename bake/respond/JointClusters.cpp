#include "bake/respond/JointClusters.h"

#include "bake/respond/JointAdvance.h"
#include "bake/table/TableKernels.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What rounding may do to lengths compared here, as a share of them.
constexpr double hair = 1e-7;

/// Where no more than some pairs are wanted, no more than so many times as many are asked in a table.
constexpr std::uint32_t askedEach = 16;

/// How the pairs of a group may come nearer on one way.
struct Closing {
    double most = 0; ///< of the speed bounds of all pairs
    double bend = 0; ///< half of the largest bound of acceleration
    double kept = 0; ///< a pair that stays farther apart than this cannot matter
};

Closing closingOf(const JointModel::Group& group, const DofValues& step) {
    Closing closing;
    double turning = 0, acceleration = 0;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        const double change = std::abs(step[group.dofs[k]]), turn = group.turnRates[k] * change;
        closing.most += group.fastest[k] * change;
        acceleration += group.fastest[k] * change * (turn + 2 * turning);
        turning += turn;
    }
    closing.bend = group.paths ? infinity : 0.5 * acceleration; // the rate of a path jumps at its rows
    closing.kept = 2 * group.contactOffset;
    return closing;
}

/// Whether, by what is known, no pair can be within the margin at q.
bool stillClear(const JointModel::Group& group, const DofValues& q, double margin, const KnownNear& known) {
    double gap = known.least;
    for (std::size_t k = 0; k < group.dofs.size(); ++k)
        gap -= group.fastest[k] * std::abs(q[group.dofs[k]] - known.values[k]) * (1 + hair);
    return gap > margin;
}

/// By how much the gap of a pair may have changed from one pose to another.
double changeBetween(const JointModel::Group& group, const Pose& from, const Pose& to) {
    return (from * group.middle - to * group.middle).norm() +
           (from.linear() - to.linear()).norm() * group.spread;
}

/// Less than or equal to the gap of a bound, whatever rounding does.
double gapOfBound(const TablePair& bound, const Pose& pose) {
    const double distance = (pose * bound.b - bound.a).norm();
    return distance - bound.contactDistance - 1e-12 * (distance + std::abs(bound.contactDistance));
}

std::array<double, 12> numbersOf(const Pose& pose) {
    std::array<double, 12> numbers;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) numbers[std::size_t(4 * r + c)] = pose(r, c);
    return numbers;
}

NearPair& addNear(ResponseRoom& ws) {
    if (ws.nearCount == ws.near.size()) ws.near.resize(2 * ws.near.size() + 64);
    return ws.near[ws.nearCount++];
}

std::uint32_t binOf(const KnownNear& known, double gap) {
    const double bin = gap / known.range * KnownNear::bins;
    return bin > 0 ? std::min(static_cast<std::uint32_t>(std::min(bin, 1e6)), KnownNear::bins - 1) : 0;
}

/// Keeps the tests found where the group stands, by their gaps.
void remember(const JointModel& model, const JointModel::Group& group, const DofValues& q, const Pose& pose,
              double range, std::span<const std::uint32_t> found, KnownNear& known) {
    known.range = known.least = range;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) known.values[k] = q[group.dofs[k]];
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

/// The tests of a group that may be within the margin where it stands, more than `enough` of them not all.
std::span<const std::uint32_t> testsNear(const JointModel& model, const JointModel::Group& group,
                                         const DofValues& q, const Pose& pose, double margin,
                                         std::uint32_t enough, KnownNear& known, ResponseRoom& ws) {
    const auto nearest = [&](double gap) {
        return std::span<const std::uint32_t>(known.tests.data(), known.ends[binOf(known, gap)]);
    };
    const double changed = margin + changeBetween(group, known.pose, pose) * (1 + hair);
    if (changed <= known.range) return nearest(changed);
    TableFeatures features;
    group.prepared->features(numbersOf(pose), features);
    if (known.more == 0) known.more = group.spread / 16;
    std::uint32_t found =
        group.prepared->testsWithin(features, margin + known.more, ws.found.data(), KnownNear::most);
    if (found <= KnownNear::most) {
        remember(model, group, q, pose, margin + known.more, {ws.found.data(), found}, known);
        if (found < KnownNear::most / 4) known.more = std::min(2 * known.more, 16 * group.spread);
        return nearest(margin);
    }
    known.more = std::max(0.5 * known.more, group.spread / 1024);
    found = group.prepared->testsWithin(features, margin, ws.found.data(), enough);
    return {ws.found.data(), found};
}

bool listGroup(const JointModel& model, std::size_t g, const DofValues& q, const DofValues& step,
               std::size_t most, ResponseRoom& ws) {
    const JointModel::Group& group = model.groups[g];
    const Closing closing = closingOf(group, step);
    if (stillClear(group, q, closing.kept + closing.most * (1 + hair), ws.known[g])) return true;
    placeGroup(model, g, q, step, ws);
    const MotionFrame& frame = ws.groups[g].frame;
    const DofTwist whole = twistOfStep(group, frame, step);
    const double fastest =
        whole.velocity(frame.pose * group.middle).norm() + whole.turn.norm() * group.spread;
    const double margin = closing.kept + std::min(closing.most, fastest + closing.bend) * (1 + hair);
    const std::uint32_t enough = most < ~0u / askedEach
                                     ? std::max(KnownNear::most, static_cast<std::uint32_t>(most) * askedEach)
                                     : ~0u;
    const std::span<const std::uint32_t> tests =
        testsNear(model, group, q, frame.pose, margin * (1 + hair), enough, ws.known[g], ws);
    if (tests.size() > enough) return false;
    const auto gapOf = [&](std::uint32_t test, Vec3& centre, Vec3& normal) {
        return pairGap(model.pairs[group.firstPair + test], frame.pose, centre, normal);
    };
    std::size_t count = 0;
    Vec3 centre, normal;
    for (const std::uint32_t test : tests) {
        const double gap = gapOf(test, centre, normal);
        if (gap > margin) continue;
        const double rate = normal.dot(whole.velocity(centre));
        if (gap > closing.kept && gap + std::min(0.0, rate) - closing.bend > closing.kept) continue;
        if (ws.listed[group.firstPair + test] != ws.listing) ws.found[count++] = test;
    }
    if (count > most - std::min(most, ws.nearCount)) return false;
    // The same order whatever was known before.
    std::sort(ws.found.begin(), ws.found.begin() + std::ptrdiff_t(count));
    for (std::size_t i = 0; i < count; ++i) {
        NearPair& near = addNear(ws);
        near.pair = group.firstPair + ws.found[i];
        near.gap = gapOf(ws.found[i], centre, normal);
        near.threshold = std::min(group.contactOffset, near.gap);
        ws.listed[near.pair] = ws.listing;
    }
    return true;
}

} // namespace

bool listOnStep(const JointModel& model, const DofValues& q, const DofValues& step, ResponseRoom& ws,
                std::size_t most) {
    if (!model.clustered) return true;
    for (std::size_t g = 0; g < model.groups.size(); ++g)
        if (model.groups[g].clustered && !listGroup(model, g, q, step, most, ws)) return false;
    return true;
}

double smallestGap(const JointModel& model, std::size_t g, const Pose& pose) {
    const JointModel::Group& group = model.groups[g];
    const TableClusters& clusters = group.prepared->kernels().clusters();
    const std::span<const TablePair> groups = clusters.groups(), bounds = clusters.bounds();
    double smallest = infinity;
    Vec3 centre, normal;
    const auto askCluster = [&](std::size_t c) {
        const std::size_t first = c * clusters.testsEach();
        const std::size_t last = std::min(first + clusters.testsEach(), clusters.order().size());
        for (std::size_t i = first; i < last; ++i)
            smallest = std::min(
                smallest, pairGap(model.pairs[group.firstPair + clusters.order()[i]], pose, centre, normal));
    };
    const auto askGroup = [&](std::size_t of) {
        const std::size_t first = of * clusters.clustersEach();
        const std::size_t last = std::min(first + clusters.clustersEach(), bounds.size());
        for (std::size_t c = first; c < last; ++c)
            if (gapOfBound(bounds[c], pose) < smallest) askCluster(c);
    };
    std::size_t nearest = 0;
    double least = infinity;
    for (std::size_t of = 0; of < groups.size(); ++of)
        if (const double gap = gapOfBound(groups[of], pose); gap < least) least = gap, nearest = of;
    askGroup(nearest);
    for (std::size_t of = 0; of < groups.size(); ++of)
        if (of != nearest && gapOfBound(groups[of], pose) < smallest) askGroup(of);
    return smallest;
}

} // namespace tss
