#include "bake/respond/JointClusters.h"

#include "bake/base/Infinity.h"
#include "bake/respond/JointAdvance.h"
#include "bake/respond/NearTests.h"
#include "bake/table/TableKernels.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// A listing limited to `most` pairs tests at most this many times as many of one table.
constexpr std::uint32_t testedPerListed = 16;

/// A lower bound of the gap of a cluster's bounding spheres, rounding included.
double gapOfBound(const TablePair& bound, const Pose& pose) {
    const double distance = (pose * bound.b - bound.a).norm();
    return distance - bound.contactDistance - 1e-12 * (distance + std::abs(bound.contactDistance));
}

NearPair& addNear(ResponseBuffers& ws) {
    if (ws.nearCount == ws.near.size()) ws.near.resize(2 * ws.near.size() + 64);
    return ws.near[ws.nearCount++];
}

bool listGroup(const JointModel& model, std::size_t g, const DofValues& q, const DofValues& step,
               std::size_t most, ResponseBuffers& ws) {
    const JointModel::Group& group = model.groups[g];
    if (staysClear(model, g, q, step, ws)) return true;
    placeGroup(model, g, q, step, ws);
    const MotionFrame& frame = ws.groups[g].frame;
    const DofTwist whole = twistOfStep(group, frame, step);
    const ClosingBounds closing = closingBounds(group, step);
    const double relevant = relevantGap(group);
    const double margin =
        relevant +
        std::min(closing.speed, fastestRate(group, frame, whole) + closing.curvature) * (1 + lengthRounding);
    const std::uint32_t enough =
        most < ~0u / testedPerListed
            ? std::max(NearCache::most, static_cast<std::uint32_t>(most) * testedPerListed)
            : ~0u / 2;
    const std::span<const std::uint32_t> tests =
        testsNear(model, g, q, margin * (1 + lengthRounding), 2 * enough, ws);
    if (tests.size() > 2 * enough) return false;
    const auto gapOf = [&](std::uint32_t test, Vec3& centre, Vec3& normal) {
        return pairGap(model.pairs[group.firstPair + test], frame.pose, centre, normal);
    };
    // The search is in floats and may return tests beyond the margin: they must not influence the result.
    std::size_t count = 0, within = 0;
    Vec3 centre, normal;
    for (const std::uint32_t test : tests) {
        const double gap = gapOf(test, centre, normal);
        if (gap > margin) continue;
        ++within;
        const double rate = normal.dot(whole.velocity(centre));
        if (gap > relevant && gap + std::min(0.0, rate) - closing.curvature > relevant) continue;
        if (ws.listed[group.firstPair + test] != ws.listing) ws.found[count++] = test;
    }
    if (within > enough || count > most - std::min(most, ws.nearCount)) return false;
    // The order must not depend on what the cache held.
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

bool listOnStep(const JointModel& model, const DofValues& q, const DofValues& step, ResponseBuffers& ws,
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
    const auto visitCluster = [&](std::size_t c) {
        const std::size_t first = c * clusters.testsEach();
        const std::size_t last = std::min(first + clusters.testsEach(), clusters.order().size());
        for (std::size_t i = first; i < last; ++i)
            smallest = std::min(
                smallest, pairGap(model.pairs[group.firstPair + clusters.order()[i]], pose, centre, normal));
    };
    // Bounds [first, last) of a level, the nearest first.
    const auto visit = [&](const auto& self, std::size_t level, std::size_t first, std::size_t last) -> void {
        const std::vector<TablePair>& bounds = clusters.levels()[level];
        const auto below = [&](std::size_t k) {
            const std::size_t of = clusters.ofGroup();
            if (level == 0) return visitCluster(k);
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
    visit(visit, top, 0, clusters.levels()[top].size());
    return smallest;
}

} // namespace tss
