#pragma once
#include "bake/base/Error.h"
#include "bake/pipeline/Bake.h"

namespace tss {

/// What bake() would refuse of the pairs and skins that are wanted, each with the prim that it belongs to;
/// empty: nothing that shows without making spheres. Takes no longer than reading the scene.
std::vector<InputError> refusedByBake(const SceneModel& scene, const BakeRequest& request = {});

/// The same of muscles that lie under no skin: bake has nothing to do with them, but they do not play.
std::vector<InputError> unplayableMuscles(const SceneModel& scene);

} // namespace tss
