#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// What a pass over all body pairs of a scene found.
struct AllPairs {
    /// Two bodies that cannot be a pair of ours.
    struct Unmade {
        int bodyA = -1, bodyB = -1;
        std::string note; ///< both, and why
    };
    std::vector<std::string> added; ///< paths of the new pairs, in the order of the scene's bodies
    std::vector<Unmade> unmade;
};

/// Makes a pair of every two rigid bodies with geometry that exactly one chain of joints links and that are
/// none yet: neighbours take the path of their joint, others get a prim beside the first body that names
/// both. Left out are bodies that do not move against each other, neighbours whose joint switches their
/// collision off (physics:collisionEnabled), skins and muscles. Left out with a note: chains without finite
/// limits, with too many DOFs, through a path backwards from both ends, and closed loops. The scene's layer,
/// where it has one, gets the new prims too.
AllPairs addAllPairs(SceneModel& scene);

} // namespace tss
