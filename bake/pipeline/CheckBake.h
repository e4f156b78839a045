#pragma once
#include "bake/base/Error.h"
#include "bake/pipeline/Bake.h"

namespace tss {

/// What bake() would refuse of the pairs and skins that are wanted, each with the prim that it belongs to;
/// empty: nothing that shows without making spheres. Takes no longer than reading the scene.
std::vector<InputError> refusedByBake(const SceneModel& scene, const BakeRequest& request = {});

} // namespace tss
