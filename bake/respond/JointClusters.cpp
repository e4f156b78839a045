#include "bake/respond/JointClusters.h"

#include "bake/base/Infinity.h"
#include "bake/respond/JointAdvance.h"
#include "bake/respond/NearTests.h"
#include "bake/table/TableKernels.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Where no more than some pairs are wanted, no more than so many times as many are asked in a table.
constexpr std::uint32_t askedEach = 16;

/// Less than or equal to the gap of a bound, whatever rounding does.
double gapOfBound(const TablePair& bound, const Pose& pose) {
    const double distance = (pose * bound.b - bound.a).norm();
    return distance - bound.contactDistance - 1e-12 * (distance + std::abs(bound.contactDistance));
}

NearPair& addNear(ResponseRoom& ws) {
    if (ws.nearCount == ws.near.size()) ws.near.resize(2 * ws.near.size() + 64);
    return ws.near[ws.nearCount++];
}

bool listGroup(const JointModel& model, std::size_t g, const DofValues& q, const DofValues& step,
               std::size_t most, ResponseRoom& ws) {
    const JointModel::Group& group = model.groups[g];
    if (stillClear(model, g, q, step, ws)) return true;
    placeGroup(model, g, q, step, ws);
    const MotionFrame& frame = ws.groups[g].frame;
    const DofTwist whole = twistOfStep(group, frame, step);
    const Closing closing = closingOf(group, step);
    const double kept = keptFrom(group);
    const double margin =
        kept + std::min(closing.most, fastestRate(group, frame, whole) + closing.bend) * (1 + hair);
    const std::uint32_t enough = most < ~0u / askedEach
                                     ? std::max(KnownNear::most, static_cast<std::uint32_t>(most) * askedEach)
                                     : ~0u / 2;
    const std::span<const std::uint32_t> tests = testsNear(model, g, q, margin * (1 + hair), 2 * enough, ws);
    if (tests.size() > 2 * enough) return false;
    const auto gapOf = [&](std::uint32_t test, Vec3& centre, Vec3& normal) {
        return pairGap(model.pairs[group.firstPair + test], frame.pose, centre, normal);
    };
    // What floats find beyond the margin decides nothing.
    std::size_t count = 0, within = 0;
    Vec3 centre, normal;
    for (const std::uint32_t test : tests) {
        const double gap = gapOf(test, centre, normal);
        if (gap > margin) continue;
        ++within;
        const double rate = normal.dot(whole.velocity(centre));
        if (gap > kept && gap + std::min(0.0, rate) - closing.bend > kept) continue;
        if (ws.listed[group.firstPair + test] != ws.listing) ws.found[count++] = test;
    }
    if (within > enough || count > most - std::min(most, ws.nearCount)) return false;
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
    double smallest = infinity;
    Vec3 centre, normal;
    const auto askCluster = [&](std::size_t c) {
        const std::size_t first = c * clusters.testsEach();
        const std::size_t last = std::min(first + clusters.testsEach(), clusters.order().size());
        for (std::size_t i = first; i < last; ++i)
            smallest = std::min(
                smallest, pairGap(model.pairs[group.firstPair + clusters.order()[i]], pose, centre, normal));
    };
    // Of a level these, the nearest first.
    const auto ask = [&](const auto& self, std::size_t level, std::size_t first, std::size_t last) -> void {
        const std::vector<TablePair>& bounds = clusters.levels()[level];
        const auto below = [&](std::size_t k) {
            const std::size_t of = clusters.ofGroup();
            if (level == 0) return askCluster(k);
            self(self, level - 1, k * of, std::min((k + 1) * of, clusters.levels()[level - 1].size()));
        };
        std::size_t nearest = first;
        double least = infinity;
        for (std::size_t k = first; k < last; ++k)
            if (const double gap = gapOfBound(bounds[k], pose); gap < least) least = gap, nearest = k;
        if (!(least < smallest)) return;
        below(nearest);
        for (std::size_t k = first; k < last; ++k)
            if (k != nearest && gapOfBound(bounds[k], pose) < smallest) below(k);
    };
    const std::size_t top = clusters.levels().size() - 1;
    ask(ask, top, 0, clusters.levels()[top].size());
    return smallest;
}

} // namespace tss
