#pragma once
#include "bake/model/SceneModel.h"
#include "bake/respond/JointResponder.h"

#include <memory>
#include <string>
#include <vector>

namespace tss {

/// How the joints of some pairs are resolved: made once from the scene, shared by all instances and threads.
struct JointPlan {
    /// Tables that are resolved together.
    struct Group {
        std::vector<int> pairs;         ///< of the scene, in the order of the responder's tables
        std::vector<std::size_t> slots; ///< of each value of the responder, its place among all values
        JointResponder responder;
    };

    std::vector<int> joints;             ///< of the scene, in the order of their values
    std::vector<std::size_t> firstValue; ///< of each joint
    std::size_t valueCount = 0;
    std::vector<Group> groups;
};

/// The answer of a group, and which of its tables stopped the joints.
struct GroupAnswer : JointAnswer {
    std::vector<int> held; ///< indices into the group's pairs; at least one where the group is not Free
};

/// Pairs without a table are ignored. All tables go into one group; where that has more values than a
/// responder supports, into as few groups as are found. Pairs that cannot be resolved are left out. warnings:
/// receives which and why, and pairs whose table is too coarse for its joint or reports contact at rest.
/// Throws InputError for a scene that checkIndices() refuses.
std::shared_ptr<const JointPlan> makeJointPlan(const SceneModel& scene,
                                               const std::vector<std::string>& pairPaths,
                                               std::vector<std::string>* warnings = nullptr);

/// The scratch memory of one instance: a workspace for each group.
std::vector<JointWorkspace> workspaces(const JointPlan& plan);

/// The nearest test of one of a group's tables at q, all values (JointResponder::nearest).
QueryResult nearest(const JointPlan& plan, std::size_t group, std::size_t table, const std::vector<double>& q,
                    std::vector<JointWorkspace>& workspaces);

/// Moves all values from `last` towards `q` as far as no pair collides, and writes the values reached to q.
/// Several groups are asked in turn until none changes a value any more; where they do not agree after some
/// rounds, all values stay at `last`, and the answers tell what stopped them. A value of q that is not finite
/// stays at `last`. Returns one answer a group.
std::vector<GroupAnswer> resolve(const JointPlan& plan, const std::vector<double>& last,
                                 std::vector<double>& q, std::vector<JointWorkspace>& workspaces);

} // namespace tss
