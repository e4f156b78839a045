#include "bake/play/JointPlan.h"

#include "bake/base/Error.h"
#include "bake/base/Order.h"
#include "bake/model/CheckIndices.h"
#include "bake/model/Kinematics.h"
#include "bake/motion/MotionBound.h"
#include "bake/table/Query.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace tss {

namespace {

/// A pair with a table, and the indices of its DOFs among all values.
struct TableSlots {
    int pair;
    std::vector<std::size_t> slots;
};

/// Adds the joints of the pair to the plan where they are not in it yet.
TableSlots slotsOf(const SceneModel& scene, int pair, JointPlan& plan) {
    TableSlots placed{pair, {}};
    for (int joint : scene.pairs[pair].joints) {
        if (std::ranges::find(plan.joints, joint) != plan.joints.end()) continue;
        plan.joints.push_back(joint);
        plan.firstValue.push_back(plan.valueCount);
        plan.valueCount += scene.joints[joint].dofs.size();
    }
    for (const JointDof& dof : pairDofs(scene, scene.pairs[pair])) {
        const auto at = std::ranges::find(plan.joints, dof.joint);
        placed.slots.push_back(plan.firstValue[at - plan.joints.begin()] + dof.dof);
    }
    return placed;
}

void addGroup(const SceneModel& scene, const std::vector<TableSlots>& tables, JointPlan& plan) {
    std::vector<std::size_t> slots;
    for (const TableSlots& table : tables) slots.insert(slots.end(), table.slots.begin(), table.slots.end());
    sortOnce(slots);
    std::vector<TableOnJoint> entries;
    std::vector<int> pairs;
    for (const TableSlots& table : tables) {
        TableOnJoint entry{scene.pairs[table.pair].table.get(), {}};
        for (std::size_t slot : table.slots)
            entry.dofs.push_back(static_cast<int>(std::ranges::find(slots, slot) - slots.begin()));
        entries.push_back(entry);
        pairs.push_back(table.pair);
    }
    plan.groups.push_back({pairs, slots, JointResponder(entries, static_cast<int>(slots.size()))});
}

/// Values of joints that several tables together may have: what answers them takes time with the cube.
constexpr std::size_t mostInGroup = 16;

/// Puts the tables into groups that are answered together. A group holds at most mostInGroup values of
/// joints, or those of its first table; each table goes to the group with room for it that it adds the fewest
/// values to, or starts a new one. That gives few groups, not always the fewest.
std::vector<std::vector<TableSlots>> grouped(const std::vector<TableSlots>& tables) {
    std::vector<std::vector<TableSlots>> groups;
    std::vector<std::set<std::size_t>> slots;
    for (const TableSlots& table : tables) {
        std::size_t best = groups.size(), fewest = 0;
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const auto more = static_cast<std::size_t>(std::ranges::count_if(
                table.slots, [&](std::size_t slot) { return !slots[g].contains(slot); }));
            if ((more > 0 && slots[g].size() + more > mostInGroup) ||
                (best < groups.size() && more >= fewest))
                continue;
            best = g;
            fewest = more;
        }
        if (best == groups.size()) {
            groups.emplace_back();
            slots.emplace_back();
        }
        groups[best].push_back(table);
        slots[best].insert(table.slots.begin(), table.slots.end());
    }
    return groups;
}

void warn(std::vector<std::string>* warnings, const Pair& pair, const std::string& why) {
    if (warnings) warnings->push_back("pair " + pair.path + " is not kept apart: " + why);
}

/// Warns of a table that reports contact at rest, or keeps the bodies farther apart than they are there.
void warnAtRest(std::vector<std::string>* warnings, const Pair& pair) {
    if (!warnings) return;
    const Table& table = *pair.table;
    if (table.testCount() == 0) return;
    const double gap = query(table, restValues(table.motion)).gap, kept = 1.5 * table.epsilon;
    // Gaps of exempt pairs count from the depth at rest and are 0 there but for rounding.
    double size = 0;
    for (const Sphere& sphere : table.a) size = std::max(size, sphere.radius);
    const double rounding = 1e-6 * size;
    std::ostringstream text;
    if (gap < -rounding)
        text << "its table says contact where the joint rests, which is held there or pushed out";
    else if (gap > rounding && gap < kept)
        text << "its table is too coarse: it keeps the bodies " << kept
             << " apart (1.5 epsilon), and they are " << gap << " apart where the joint rests";
    else
        return;
    warnings->push_back("pair " + pair.path + ": " + text.str());
}

/// Adds the tables as one group, or each as a group of its own where they cannot be resolved together.
void addGroups(const SceneModel& scene, const std::vector<TableSlots>& tables, JointPlan& plan,
               std::vector<std::string>* warnings) {
    try {
        return addGroup(scene, tables, plan);
    } catch (const InputError& error) {
        if (tables.size() == 1) return warn(warnings, scene.pairs[tables[0].pair], error.what());
    }
    for (const TableSlots& table : tables) addGroups(scene, {table}, plan, warnings);
}

} // namespace

std::shared_ptr<const JointPlan> makeJointPlan(const SceneModel& scene,
                                               const std::vector<std::string>& pairPaths,
                                               std::vector<std::string>* warnings) {
    checkIndices(scene);
    auto plan = std::make_shared<JointPlan>();
    std::vector<TableSlots> tables;
    for (const std::string& path : pairPaths) {
        const int index = findPair(scene, path);
        if (index < 0 || !scene.pairs[index].table) continue;
        const TableSlots table = slotsOf(scene, index, *plan);
        if (table.slots.size() == scene.pairs[index].table->motion.dofCount()) {
            tables.push_back(table);
            warnAtRest(warnings, scene.pairs[index]);
        } else
            warn(warnings, scene.pairs[index], "its joints have other degrees of freedom than its table");
    }
    for (const std::vector<TableSlots>& group : grouped(tables)) addGroups(scene, group, *plan, warnings);
    return plan;
}

std::vector<JointWorkspace> workspaces(const JointPlan& plan) {
    std::vector<JointWorkspace> made;
    for (const JointPlan::Group& group : plan.groups) made.push_back(group.responder.workspace());
    return made;
}

namespace {

std::vector<int> heldOf(const JointAnswer& answer, const JointWorkspace& workspace) {
    std::vector<int> held;
    for (std::size_t k = 0; answer.status != JointStatus::Free && k < workspace.held().size(); ++k)
        if (workspace.held()[k]) held.push_back(static_cast<int>(k));
    return held;
}

} // namespace

QueryResult nearest(const JointPlan& plan, std::size_t group, std::size_t table, const std::vector<double>& q,
                    std::vector<JointWorkspace>& workspaces) {
    const JointPlan::Group& of = plan.groups[group];
    DofValues values;
    for (std::size_t k = 0; k < of.slots.size(); ++k) values[k] = q[of.slots[k]];
    return of.responder.nearest(table, values.data(), workspaces[group]);
}

std::vector<GroupAnswer> resolve(const JointPlan& plan, const std::vector<double>& last,
                                 std::vector<double>& q, std::vector<JointWorkspace>& workspaces) {
    constexpr int mostRounds = 16;
    std::vector<GroupAnswer> answers(plan.groups.size());
    std::vector<DofValues> left(plan.groups.size()); ///< by each group when it last answered
    bool settled = false;
    for (int round = 0; round < mostRounds && !settled; ++round) {
        settled = true;
        for (std::size_t g = 0; g < plan.groups.size(); ++g) {
            const JointPlan::Group& group = plan.groups[g];
            DofValues from{}, asked{};
            for (std::size_t k = 0; k < group.slots.size(); ++k) {
                from[k] = last[group.slots[k]];
                asked[k] = q[group.slots[k]];
            }
            if (round > 0 && asked == left[g]) continue; // no other group has moved it
            const JointAnswer answer = group.responder.respond(from.data(), asked.data(), workspaces[g]);
            bool changed = false;
            for (std::size_t k = 0; k < group.slots.size(); ++k) {
                changed = changed || answer.q[k] != asked[k];
                q[group.slots[k]] = answer.q[k];
            }
            left[g] = answer.q;
            // A group's answer is that of the first round, or of the last that changed a value.
            if (round == 0 || changed) answers[g] = {answer, heldOf(answer, workspaces[g])};
            if (changed && plan.groups.size() > 1) settled = false;
        }
    }
    if (!settled) q = last;
    return answers;
}

} // namespace tss
