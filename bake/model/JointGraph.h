#pragma once
#include "bake/model/SceneModel.h"

#include <optional>

namespace tss {

/// The graph of a scene's bodies, joints being its edges, those that are not enabled left out. The world, -1,
/// counts as a body that joints may share.
class JointGraph {
public:
    explicit JointGraph(const std::vector<Joint>& joints);
    /// Indices of the joints that lead from one body to another, in this order; empty when none do, nothing
    /// when there is more than one way.
    std::optional<std::vector<int>> chain(int bodyA, int bodyB) const;

private:
    struct Step {
        int joint, body;
    };

    // A spanning forest of the bodies, the world first: of each body the step to its parent, and its depth.
    std::vector<Step> above_;
    std::vector<int> depth_;
    std::vector<bool> only_; ///< by joint: it is in no loop
};

/// One chain() of the graph of these joints.
std::optional<std::vector<int>> findChain(const std::vector<Joint>& joints, int bodyA, int bodyB);

} // namespace tss
