#pragma once
#include "bake/robot/PairEvidence.h"
#include "bake/scene/Layer.h"

namespace tss {

/// How many pairs a file switches off, and how many it leaves on.
struct PairsWritten {
    std::string text;
    std::size_t never = 0, adjacent = 0, always = 0, meets = 0, open = 0;
};

/// An SRDF of the scene's robot that holds its pairs alone: disable_collisions with reason Never where
/// proven, Adjacent for links that are joined (also where links without geometry are between, as MoveIt
/// counts it), Always for those that are fixed to each other and overlap; a comment with the clearance, or
/// with the pose that shows that they meet. All others stay on, with that pose in a comment.
PairsWritten srdfOf(const SceneModel& scene, const std::vector<PairEvidence>& evidence,
                    const std::string& source);

/// The same as exclude elements of MuJoCo, in a file to include in a model.
PairsWritten mjcfExcludesOf(const SceneModel& scene, const std::vector<PairEvidence>& evidence,
                            const std::string& source);

/// The scene's layer with UsdPhysics' filtered pairs for all that is proven never to meet:
/// PhysicsFilteredPairsAPI on the first body of each.
Layer withFilteredPairs(const SceneModel& scene, const std::vector<PairEvidence>& evidence);

} // namespace tss
