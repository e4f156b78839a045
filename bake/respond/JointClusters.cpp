#include "bake/respond/JointClusters.h"

#include "bake/respond/JointAdvance.h"
#include "bake/table/TableKernels.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// What rounding may do to lengths compared here, as a share of them.
constexpr double hair = 1e-9;

/// How the pairs of a group may come nearer on one way.
struct Closing {
    double most = 0; ///< of the speed bounds of all pairs
    double bend = 0; ///< half of the largest bound of acceleration
    double kept = 0; ///< a pair that stays farther apart than this cannot matter
};

Closing closingOf(const JointModel::Group& group, const DofValues& way) {
    Closing closing;
    double turning = 0, acceleration = 0;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        const double change = std::abs(way[group.dofs[k]]), turn = group.turnRates[k] * change;
        closing.most += group.fastest[k] * change;
        acceleration += group.fastest[k] * change * (turn + 2 * turning);
        turning += turn;
    }
    closing.bend = group.paths ? infinity : 0.5 * acceleration; // the rate of a path jumps at its rows
    closing.kept = 2 * group.contactOffset;
    return closing;
}

/// The gap that all pairs of a group have at least at q, by what is known of another place.
double knownGap(const JointModel::Group& group, const DofValues& q, const KnownClear& known) {
    double gap = known.gap;
    for (std::size_t k = 0; k < group.dofs.size(); ++k)
        gap -= group.fastest[k] * std::abs(q[group.dofs[k]] - known.at[k]) * (1 + hair);
    return gap;
}

/// Less than or equal to the gap of a bound, whatever rounding does.
double gapOfBound(const TablePair& bound, const Pose& pose) {
    const double distance = (pose * bound.b - bound.a).norm();
    return distance - bound.reach - 1e-12 * (distance + std::abs(bound.reach));
}

/// No gap is less than this: by the bounds of all groups of clusters.
double leastOfBounds(const TableClusters& clusters, const Pose& pose) {
    double least = infinity;
    for (const TablePair& bound : clusters.groups()) least = std::min(least, gapOfBound(bound, pose));
    return least;
}

void remember(const JointModel::Group& group, const DofValues& q, double gap, KnownClear& known) {
    for (std::size_t k = 0; k < group.dofs.size(); ++k) known.at[k] = q[group.dofs[k]];
    known.gap = gap;
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

bool listGroup(const JointModel& model, std::size_t g, const DofValues& q, const DofValues& way,
               std::size_t most, ResponseRoom& ws) {
    const JointModel::Group& group = model.groups[g];
    const Closing closing = closingOf(group, way);
    if (knownGap(group, q, ws.clear[g]) > closing.kept + closing.most * (1 + hair)) return true;
    placeGroup(model, g, q, way, ws);
    const MotionFrame& frame = ws.groups[g].frame;
    const DofTwist whole = twistOfWay(group, frame, way);
    const double fastest =
        whole.velocity(frame.pose * group.middle).norm() + whole.turn.norm() * group.spread;
    const double margin = closing.kept + std::min(closing.most, fastest + closing.bend) * (1 + hair);
    TableFeatures features;
    group.prepared->features(numbersOf(frame.pose), features);
    const std::uint32_t found = group.prepared->testsWithin(features, margin * (1 + hair), ws.found.data());
    if (found == 0) {
        const double clear = leastOfBounds(group.prepared->kernels().clusters(), frame.pose);
        remember(group, q, std::max(margin, clear), ws.clear[g]);
    }
    for (std::uint32_t i = 0; i < found; ++i) {
        const std::uint32_t p = group.firstPair + ws.found[i];
        if (ws.listed[p] == ws.listing) continue;
        Vec3 centre, normal;
        const double gap = pairGap(model.pairs[p], frame.pose, centre, normal);
        if (gap > margin) continue; // whatever else the kernel's rounding finds
        const double rate = normal.dot(whole.velocity(centre));
        if (gap > closing.kept && gap + std::min(0.0, rate) - closing.bend > closing.kept) continue;
        if (ws.nearCount >= most) return false;
        ws.listed[p] = ws.listing;
        NearPair& near = addNear(ws);
        near.pair = p;
        near.gap = gap;
        near.threshold = std::min(group.contactOffset, gap);
    }
    return true;
}

} // namespace

bool listOnWay(const JointModel& model, const DofValues& q, const DofValues& way, ResponseRoom& ws,
               std::size_t most) {
    if (!model.clustered) return true;
    for (std::size_t g = 0; g < model.groups.size(); ++g)
        if (model.groups[g].clustered && !listGroup(model, g, q, way, most, ws)) return false;
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
