#pragma once
#include "bake/respond/JointResponder.h"
#include "bake/scene/SceneModel.h"

#include <memory>
#include <string>
#include <vector>

namespace osgTSS {

/// How the joints of some pairs are resolved: made once from the scene, shared by all instances and threads.
struct JointPlan {
    /// Tables that are resolved in one go.
    struct Group {
        std::vector<int> pairs;         ///< of the scene, in the order of the responder's tables
        std::vector<std::size_t> slots; ///< of each value of the responder, its place among all values
        tss::JointResponder responder;
    };

    std::vector<int> joints;             ///< of the scene, in the order of their values
    std::vector<std::size_t> firstValue; ///< of each joint
    std::size_t valueCount = 0;
    std::vector<Group> groups;
};

/// Pairs without a table are passed over. All tables go into one group; where that has more values than a
/// response serves, each table into its own. What cannot be served is left out, with a warning.
std::shared_ptr<const JointPlan> makeJointPlan(const tss::SceneModel& scene,
                                               const std::vector<std::string>& pairPaths);

/// What one instance needs beside its values.
std::vector<tss::JointWorkspace> workspaces(const JointPlan& plan);

/// Takes all values from `last` towards `q` so that no pair collides, and leaves in q what was reached.
/// Several groups are asked in turn until none changes anything any more; where they do not agree after some
/// rounds everything stays at `last`. One answer a group.
std::vector<tss::JointAnswer> resolve(const JointPlan& plan, const std::vector<double>& last,
                                      std::vector<double>& q, std::vector<tss::JointWorkspace>& workspaces);

} // namespace osgTSS
