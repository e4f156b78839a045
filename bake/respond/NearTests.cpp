#include "bake/respond/NearTests.h"

#include "bake/respond/JointAdvance.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Bound of how far the gap of any pair of the group differs between two poses.
double changeBetween(const JointModel::Group& group, const Pose& from, const Pose& to) {
    return ((from * group.middle - to * group.middle).norm() +
            (from.linear() - to.linear()).norm() * group.spread) *
           (1 + lengthRounding);
}

std::uint32_t binOf(const NearCache& cache, double gap) {
    const double bin = gap / cache.range * NearCache::bins;
    return bin > 0 ? std::min(static_cast<std::uint32_t>(std::min(bin, 1e6)), NearCache::bins - 1) : 0;
}

/// Stores in the cache the tests found at a pose, sorted into bins by their gaps (counting sort).
void storeTests(const JointModel& model, const JointModel::Group& group, const Pose& pose, double range,
                std::span<const std::uint32_t> found, NearCache& cache) {
    cache.range = cache.smallestGap = range;
    cache.pose = pose;
    std::array<std::uint8_t, NearCache::most> bins;
    std::array<std::uint32_t, NearCache::bins + 1> counts{};
    Vec3 centre, normal;
    for (std::size_t i = 0; i < found.size(); ++i) {
        const double gap = pairGap(model.pairs[group.firstPair + found[i]], pose, centre, normal);
        cache.smallestGap = std::min(cache.smallestGap, gap);
        bins[i] = static_cast<std::uint8_t>(binOf(cache, gap));
        ++counts[bins[i] + 1u];
    }
    for (std::uint32_t bin = 0; bin < NearCache::bins; ++bin) counts[bin + 1] += counts[bin];
    for (std::size_t i = 0; i < found.size(); ++i) cache.tests[counts[bins[i]]++] = found[i];
    std::copy_n(counts.begin(), NearCache::bins, cache.binEnds.begin());
}

void storeClearance(const JointModel::Group& group, const DofValues& q, const MotionFrame& frame,
                    double clearance, NearCache& cache) {
    cache.clearance = clearance;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) cache.values[k] = q[group.dofs[k]];
    cache.frame.pose = frame.pose;
    std::copy_n(frame.twists.begin(), group.dofs.size(), cache.frame.twists.begin());
}

} // namespace

std::span<const std::uint32_t> testsNear(const JointModel& model, std::size_t g, const DofValues& q,
                                         double margin, std::uint32_t enough, ResponseBuffers& ws) {
    const JointModel::Group& group = model.groups[g];
    const MotionFrame& frame = ws.groups[g].frame;
    NearCache& cache = ws.caches[g];
    const auto nearest = [&](double gap) {
        return std::span<const std::uint32_t>(cache.tests.data(), cache.binEnds[binOf(cache, gap)]);
    };
    const double change = changeBetween(group, cache.pose, frame.pose);
    if (margin + change <= cache.range) {
        storeClearance(group, q, frame, cache.smallestGap - change, cache);
        return nearest(margin + change);
    }
    if (cache.extraRange == 0) cache.extraRange = group.spread / 16;
    const auto find = [&](double within, std::uint32_t most) {
        return group.tree->testsWithin(frame.pose, within, most, ws.found.data());
    };
    std::uint32_t found = find(margin + cache.extraRange, NearCache::most);
    if (found <= NearCache::most) {
        storeTests(model, group, frame.pose, margin + cache.extraRange, {ws.found.data(), found}, cache);
        storeClearance(group, q, frame, cache.smallestGap, cache);
        if (found < NearCache::most / 4) cache.extraRange = std::min(2 * cache.extraRange, 16 * group.spread);
        return nearest(margin);
    }
    cache.extraRange = std::max(0.5 * cache.extraRange, group.spread / 1024);
    found = find(margin, enough);
    return {ws.found.data(), found};
}

ClosingBounds closingBounds(const JointModel::Group& group, const DofValues& step) {
    ClosingBounds closing;
    double turning = 0, acceleration = 0;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        const double change = std::abs(step[group.dofs[k]]), turn = group.turnRates[k] * change;
        closing.speed += group.fastest[k] * change;
        acceleration += group.fastest[k] * change * (turn + 2 * turning);
        turning += turn;
    }
    // The rate of a path jumps at its rows, so that no acceleration bounds it.
    closing.curvature = group.paths ? infinity : 0.5 * acceleration;
    return closing;
}

double fastestRate(const JointModel::Group& group, const MotionFrame& frame, const DofTwist& whole) {
    return whole.velocity(frame.pose * group.middle).norm() + whole.turn.norm() * group.spread;
}

bool staysClear(const JointModel& model, std::size_t g, const DofValues& q, const DofValues& step,
                const ResponseBuffers& ws) {
    const JointModel::Group& group = model.groups[g];
    const NearCache& cache = ws.caches[g];
    const double room = cache.clearance - relevantGap(group);
    if (!(room > 0)) return false;
    // The way seen from the cached values: it begins at `first`, ends at `last`, and each DOF stays within
    // `farther` of its cached value.
    DofValues first{}, last{}, farther{};
    bool moved = false;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        const int l = group.dofs[k];
        first[l] = q[l] - cache.values[k];
        last[l] = first[l] + step[l];
        farther[l] = std::max(std::abs(first[l]), std::abs(last[l]));
        moved = moved || first[l] != 0;
    }
    const ClosingBounds closing = closingBounds(group, farther);
    if (closing.speed * (1 + lengthRounding) < room) return true;
    const auto rate = [&](const DofValues& way) {
        return fastestRate(group, cache.frame, twistOfStep(group, cache.frame, way));
    };
    const double fastest = moved ? std::max(rate(first), rate(last)) : rate(last);
    return (fastest + closing.curvature) * (1 + lengthRounding) < room;
}

} // namespace tss
