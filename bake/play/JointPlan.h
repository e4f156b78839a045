#pragma once
#include "bake/model/SceneModel.h"
#include "bake/respond/JointResponder.h"

#include <memory>
#include <string>
#include <vector>

namespace tss {

/// How the joints of some pairs are resolved: made once from the scene, shared by all instances and threads.
struct JointPlan {
    /// Tables that are resolved in one go.
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

/// What came of a group, and which of its tables held it.
struct GroupAnswer : JointAnswer {
    std::vector<int> held; ///< places in the group's pairs; of a group that is not Free at least one
};

/// Pairs without a table are passed over. All tables go into one group; where that has more values than a
/// response serves, into as few as are found. What cannot be served is left out;
/// `warnings` then says which pair and why, and what of the others a person should know: a table that is too
/// coarse for its joint, or says contact where that rests. Throws InputError for a scene that checkIndices()
/// refuses.
std::shared_ptr<const JointPlan> makeJointPlan(const SceneModel& scene,
                                               const std::vector<std::string>& pairPaths,
                                               std::vector<std::string>* warnings = nullptr);

/// What one instance needs beside its values.
std::vector<JointWorkspace> workspaces(const JointPlan& plan);

/// The nearest test of one of a group's tables at q, all values (JointResponder::nearest).
QueryResult nearest(const JointPlan& plan, std::size_t group, std::size_t table, const std::vector<double>& q,
                    std::vector<JointWorkspace>& workspaces);

/// Takes all values from `last` towards `q` so that no pair collides, and leaves in q what was reached.
/// Several groups are asked in turn until none changes anything any more; where they do not agree after some
/// rounds everything stays at `last`, and the answers tell what stopped them. A value of q that is no finite
/// number stays at `last`. One answer a group.
std::vector<GroupAnswer> resolve(const JointPlan& plan, const std::vector<double>& last,
                                 std::vector<double>& q, std::vector<JointWorkspace>& workspaces);

} // namespace tss
