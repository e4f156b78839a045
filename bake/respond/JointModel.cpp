#include "bake/respond/JointModel.h"

#include "bake/base/Error.h"
#include "bake/motion/LimitConflict.h"
#include "bake/motion/WholeTurn.h"
#include "bake/respond/JointClusters.h"
#include "bake/table/TableKernels.h"

#include <atomic>
#include <cmath>
#include <limits>

namespace tss {

namespace {

void checkFit(const TableOnJoint& entry, int dofCount) {
    const Motion& motion = entry.table->motion;
    if (entry.dofs.size() != motion.dofCount())
        throw InputError("joint: expected a place among its values for each DOF of each table's motion");
    for (std::size_t k = 0; k < entry.dofs.size(); ++k)
        if (entry.dofs[k] < 0 || entry.dofs[k] >= dofCount ||
            std::count(entry.dofs.begin(), entry.dofs.end(), entry.dofs[k]) != 1)
            throw InputError("joint: expected places of DOFs in [0, " + std::to_string(dofCount) +
                             "), each once");
}

void addPairs(const Table& table, std::uint32_t group, JointModel& model) {
    const std::vector<int>& dofs = model.groups[group].dofs;
    const TableTests& list = *model.groups[group].tests;
    constexpr std::uint32_t none = ~0u;
    std::vector<std::uint32_t> rowOf(table.b.size(), none); // per sphere of B
    for (std::size_t k = 0; k < list.size(); ++k) {
        const TablePair test = list[k];
        std::uint32_t& speedRow = rowOf[list.spheres(k).b];
        const bool first = speedRow == none;
        if (first) speedRow = model.speedRows++;
        model.pairs.push_back({test.a, test.b, test.contactDistance, group, speedRow});
        if (!first) continue;
        DofValues own;
        speedBounds(table.motion, test.b, own.data());
        const std::size_t row = model.speeds.size();
        model.speeds.resize(row + model.dofCount, 0.0);
        for (std::size_t l = 0; l < dofs.size(); ++l) {
            model.speeds[row + dofs[l]] = own[l];
            model.weights[dofs[l]] = std::max(model.weights[dofs[l]], own[l]);
            model.groups[group].fastest[l] = std::max(model.groups[group].fastest[l], own[l]);
        }
    }
}

/// The group's contactOffset (METHOD 5.3): 1.5 epsilon of its own table, so that a coarse table does not keep
/// the bodies of others farther apart. Where epsilon is 0, a distance far above the rounding of a gap and far
/// below what can be seen.
double contactOffsetOf(const JointModel& model, const JointModel::Group& group, double epsilon) {
    double size = 0, coordinate = group.motion.base.translation().norm();
    for (std::uint32_t i = group.firstPair; i < group.lastPair; ++i) {
        const JointModel::Pair& p = model.pairs[i];
        const TablePair test = (*group.tests)[i - group.firstPair];
        size = std::max(size, test.radiusA + test.radiusB);
        coordinate = std::max({coordinate, p.a.norm(), p.b.norm()});
    }
    for (const Dof& dof : group.motion.dofs) coordinate = std::max(coordinate, dof.origin.norm());
    return std::max({1.5 * epsilon, 1e-6 * size, 1e-13 * coordinate, std::numeric_limits<double>::min()});
}

void addTable(const TableOnJoint& entry, JointModel& model) {
    const Motion& motion = entry.table->motion;
    JointModel::Group group;
    group.motion = motion;
    group.dofs = entry.dofs;
    group.tests = std::make_shared<TableTests>(*entry.table);
    for (std::size_t k = 0; k < motion.dofs.size(); ++k) {
        const Dof& dof = motion.dofs[k];
        group.turnRates.push_back(turnBound(dof));
        group.paths = group.paths || dof.kind == DofKind::Path;
        model.lower[entry.dofs[k]] = std::max(model.lower[entry.dofs[k]], dof.lower);
        model.upper[entry.dofs[k]] = std::min(model.upper[entry.dofs[k]], dof.upper);
        model.rest[entry.dofs[k]] = dof.rest;
    }
    for (const LimitPlane& plane : motion.planes) {
        LimitPlane whole{std::vector<double>(model.dofCount, 0.0), plane.bound};
        for (std::size_t k = 0; k < motion.dofs.size(); ++k)
            whole.coefficients[entry.dofs[k]] = plane.coefficients[k];
        model.planes.push_back(rescaled(whole));
    }
    group.firstPair = static_cast<std::uint32_t>(model.pairs.size());
    model.groups.push_back(group);
    addPairs(*entry.table, static_cast<std::uint32_t>(model.groups.size() - 1), model);
    JointModel::Group& added = model.groups.back();
    added.lastPair = static_cast<std::uint32_t>(model.pairs.size());
    added.contactOffset = contactOffsetOf(model, added, entry.table->epsilon);
}

/// Makes the vector kernels of the last group's table and, where these put it into clusters, its tree and the
/// ball around its spheres of B.
void prepareGroup(const Table& table, JointModel& model) {
    JointModel::Group& group = model.groups.back();
    group.prepared = std::make_shared<PreparedTable>(table);
    group.clustered = !group.prepared->kernels().clusters().empty();
    if (!group.clustered) return;
    model.clustered = true;
    group.tree = std::make_shared<PairTree>(table, group.prepared->target());
    const std::span pairs(model.pairs.data() + group.firstPair, group.lastPair - group.firstPair);
    Vec3 lower = pairs[0].b, upper = pairs[0].b;
    for (const JointModel::Pair& pair : pairs) {
        lower = lower.cwiseMin(pair.b);
        upper = upper.cwiseMax(pair.b);
    }
    group.middle = 0.5 * (lower + upper);
    for (const JointModel::Pair& pair : pairs)
        group.spread = std::max(group.spread, (pair.b - group.middle).norm());
}

/// Assigns each group without paths a chain that begins with its DOFs, or that its DOFs extend.
void findChains(JointModel& model) {
    for (JointModel::Group& group : model.groups) {
        if (group.paths) continue;
        const auto sharesStart = [&](const JointModel::Chain& chain) {
            const std::size_t both = std::min(chain.dofs.size(), group.dofs.size());
            for (std::size_t k = 0; k < both; ++k) {
                const Dof &x = chain.motion.dofs[k], &y = group.motion.dofs[k];
                if (chain.dofs[k] != group.dofs[k] || x.kind != y.kind || x.origin != y.origin ||
                    x.axis != y.axis)
                    return false;
            }
            return both > 0;
        };
        const auto found = std::find_if(model.chains.begin(), model.chains.end(), sharesStart);
        group.chain = static_cast<int>(found - model.chains.begin());
        if (found == model.chains.end())
            model.chains.push_back({group.motion, group.dofs});
        else if (found->dofs.size() < group.dofs.size())
            *found = {group.motion, group.dofs};
    }
}

/// Finds the periodic DOFs: all their tables cover the whole turn, and no plane limits them.
void findPeriodicDofs(JointModel& model) {
    for (int l = 0; l < model.dofCount; ++l) {
        bool used = false, periodic = true;
        for (const JointModel::Group& group : model.groups)
            for (std::size_t k = 0; k < group.dofs.size(); ++k)
                if (group.dofs[k] == l) {
                    used = true;
                    periodic = periodic && wholeTurn(group.motion.dofs[k]);
                }
        periodic = periodic && used;
        for (const LimitPlane& plane : model.planes) periodic = periodic && plane.coefficients[l] == 0;
        model.periodic[l] = periodic;
        model.first[l] = model.lower[l];
        model.range[l] = periodic ? fullTurn : model.upper[l] - model.lower[l];
        if (!periodic) continue;
        // Room for a way of half a turn from any value, and for sliding beyond its end.
        model.lower[l] = model.first[l] - fullTurn;
        model.upper[l] = model.first[l] + 2 * fullTurn;
    }
}

} // namespace

JointModel makeJointModel(std::span<const TableOnJoint> tables, int dofCount) {
    if (dofCount < 0 || dofCount > static_cast<int>(maxDofs))
        throw InputError("joint: expected at most " + std::to_string(maxDofs) + " DOFs, not " +
                         std::to_string(dofCount));
    JointModel model;
    model.dofCount = dofCount;
    model.lower.fill(-infinity);
    model.upper.fill(infinity);
    model.leastContactOffset = infinity;
    std::size_t tests = 0;
    for (const TableOnJoint& entry : tables) tests += entry.table->testCount();
    model.pairs.reserve(tests);
    for (const TableOnJoint& entry : tables) {
        checkFit(entry, dofCount);
        addTable(entry, model);
        prepareGroup(*entry.table, model);
        const JointModel::Group& group = model.groups.back();
        if (!group.clustered) model.unclusteredPairs += group.lastPair - group.firstPair;
        model.leastContactOffset = std::min(model.leastContactOffset, group.contactOffset);
    }
    if (model.groups.empty()) model.leastContactOffset = std::numeric_limits<double>::min();
    for (int l = 0; l < dofCount; ++l)
        if (!model.groups.empty() && std::isinf(model.lower[l]))
            throw InputError("joint: expected each of its values to be a DOF of some table");
        else if (!(model.lower[l] <= model.upper[l]))
            throw InputError("joint: expected limits of its tables that overlap");
    for (int l = 0; l < dofCount; ++l)
        model.rest[l] = std::clamp(model.rest[l], model.lower[l], model.upper[l]);
    findPeriodicDofs(model);
    if (model.clustered) findChains(model);
    // A DOF that moves no sphere still needs a weight, or the weighted distance would not be a metric.
    const double largest = *std::max_element(model.weights.begin(), model.weights.end());
    for (int l = 0; l < dofCount; ++l)
        model.weights[l] = std::max(model.weights[l], largest > 0 ? 1e-6 * largest : 1.0);
    // With planes, whose rows have coefficients on each DOF, weighted ranges must not differ too much in
    // scale.
    double farthest = 0;
    for (int l = 0; l < dofCount; ++l) farthest = std::max(farthest, model.weights[l] * model.range[l]);
    for (int l = 0; l < dofCount; ++l)
        if (!model.planes.empty() && model.range[l] > 0)
            model.weights[l] = std::max(model.weights[l], std::min(1e-4 * farthest / model.range[l], 1e100));
    for (int l = 0; l < dofCount; ++l) model.perWeight[l] = 1 / model.weights[l];
    for (std::size_t row = 0; row < model.speedRows; ++row) {
        double squared = 0;
        for (int l = 0; l < dofCount; ++l) {
            const double share = model.speeds[row * dofCount + l] / model.weights[l];
            squared += share * share;
        }
        model.levers.push_back(std::sqrt(squared));
    }
    model.scale = weightedDistance(model, model.range, DofValues{});
    static std::atomic<std::uint64_t> made{0};
    model.id = ++made;
    return model;
}

namespace {

/// Appends a pair to the near list if its gap can fall to its threshold within the travel.
void addIfNear(const JointModel& model, std::uint32_t p, const Pose& pose, const DofValues& travel,
               ResponseBuffers& ws) {
    const JointModel::Pair& pair = model.pairs[p];
    const double* speed = model.speed(p);
    const double contactOffset = model.groups[pair.group].contactOffset;
    double far = pair.contactDistance + 2 * contactOffset;
    for (int l = 0; l < model.dofCount; ++l) far += speed[l] * travel[l];
    const double squared = (pose * pair.b - pair.a).squaredNorm();
    if (far < 0 || squared > far * far) return;
    NearPair& near = ws.near[ws.nearCount++];
    near.pair = p;
    near.gap = std::sqrt(squared) - pair.contactDistance;
    near.threshold = std::min(contactOffset, near.gap);
}

/// The values of a group's own DOFs, periodic ones brought into the table's limits, where its cells end.
DofValues valuesOf(const JointModel& model, const JointModel::Group& group, const DofValues& q) {
    DofValues own;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) {
        own[k] = q[group.dofs[k]];
        if (model.periodic[group.dofs[k]])
            own[k] = nearestTurn(own[k], group.motion.dofs[k].lower + fullTurn / 2);
    }
    return own;
}

/// Finds, with the vector kernels, the tests of a group that may be near within the travel, judged by the
/// margin that the fastest pair needs. Returns how many are in ws.found.
std::uint32_t findWithin(const JointModel& model, const JointModel::Group& group, const DofValues& q,
                         const DofValues& travel, ResponseBuffers& ws) {
    const DofValues own = valuesOf(model, group, q);
    double margin = 2 * group.contactOffset;
    for (const int dof : group.dofs) margin += model.weights[dof] * travel[dof];
    return group.prepared->testsWithin(own.data(), margin, ws.found.data());
}

} // namespace

void cull(const JointModel& model, const DofValues& q, const DofValues& travel, ResponseBuffers& ws) {
    ws.clearNear();
    cullMore(model, q, travel, ws);
}

void cullMore(const JointModel& model, const DofValues& q, const DofValues& travel, ResponseBuffers& ws) {
    // The near list may already hold pairs of clustered groups.
    if (ws.near.size() < ws.nearCount + model.unclusteredPairs)
        ws.near.resize(ws.nearCount + model.unclusteredPairs);
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
        const JointModel::Group& group = model.groups[g];
        if (group.clustered) continue;
        const std::uint32_t found = findWithin(model, group, q, travel, ws);
        if (found == 0) continue;
        placeGroup(model, g, q, travel, ws);
        for (std::uint32_t i = 0; i < found; ++i)
            addIfNear(model, group.firstPair + ws.found[i], ws.groups[g].frame.pose, travel, ws);
    }
}

QueryResult nearestTest(const JointModel& model, std::size_t g, const DofValues& q, ResponseBuffers& ws) {
    const JointModel::Group& group = model.groups[g];
    DofValues at;
    for (std::size_t k = 0; k < group.dofs.size(); ++k) at[k] = q[group.dofs[k]];
    const Pose place = pose(group.motion, {at.data(), group.dofs.size()});
    const DofValues own = valuesOf(model, group, q);
    for (std::size_t k = 0; k < group.dofs.size(); ++k)
        if (!(own[k] >= group.motion.dofs[k].lower && own[k] <= group.motion.dofs[k].upper))
            return query(*group.tests, place);
    const TableGap guess = group.prepared->gap(own.data());
    // A test that can never touch, its contact distance being below 0, is left out by testsWithin().
    if (guess.test < 0 || (*group.tests)[std::size_t(guess.test)].contactDistance < 0)
        return query(*group.tests, place);
    // Exactly, among the tests that may be the nearest within the rounding of the kernels.
    const double reach = group.prepared->kernels().reachOf(std::max(0.0, guess.gap));
    const std::uint32_t count = group.prepared->testsWithin(own.data(), reach, ws.found.data());
    return query(*group.tests, place, {ws.found.data(), count});
}

void narrow(const JointModel& model, double distance, ResponseBuffers& ws) {
    ws.removeNear(
        [&](const NearPair& near) { return near.gap - near.threshold > model.lever(near.pair) * distance; });
}

void linearise(const JointModel& model, const DofValues& q, const DofValues& step, ResponseBuffers& ws,
               std::size_t first) {
    std::uint32_t at = ~0u;
    for (std::size_t i = first; i < ws.nearCount; ++i) {
        NearPair& near = ws.near[i];
        const JointModel::Pair& pair = model.pairs[near.pair];
        if (pair.group != at) placeGroup(model, at = pair.group, q, step, ws);
        const JointModel::Group& group = model.groups[pair.group];
        const MotionFrame& frame = ws.groups[pair.group].frame;
        Vec3 centre, normal;
        near.gap = pairGap(pair, frame.pose, centre, normal);
        if (!ws.commonThreshold) near.threshold = std::min(near.threshold, near.gap);
        std::fill_n(near.gradient.begin(), model.dofCount, 0.0);
        for (std::size_t k = 0; k < group.dofs.size(); ++k)
            near.gradient[group.dofs[k]] = normal.dot(frame.twists[k].velocity(centre));
    }
}

double smallestLevel(const JointModel& model, const DofValues& q, ResponseBuffers& ws) {
    double smallest = infinity;
    Vec3 centre, normal;
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
        const JointModel::Group& group = model.groups[g];
        placeGroup(model, g, q, q, ws);
        const Pose& pose = ws.groups[g].frame.pose;
        double gap = infinity;
        if (group.clustered)
            gap = smallestGap(model, g, pose);
        else
            for (std::uint32_t p = group.firstPair; p < group.lastPair; ++p)
                gap = std::min(gap, pairGap(model.pairs[p], pose, centre, normal));
        smallest = std::min(smallest, levelOf(model, group.contactOffset, gap));
    }
    return smallest;
}

} // namespace tss
