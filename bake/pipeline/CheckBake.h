#pragma once
#include "bake/base/Error.h"
#include "bake/pipeline/Bake.h"

namespace tss {

/// Why bake() would refuse pairs and skins of the request, as far as that shows without making spheres: one
/// error each, with the path of its prim; empty: no reason was found. Takes no longer than reading the scene.
std::vector<InputError> refusedByBake(const SceneModel& scene, const BakeRequest& request = {});

/// The same of muscles that lie under no skin: bake has nothing to do with them, but they do not play.
std::vector<InputError> unplayableMuscles(const SceneModel& scene);

} // namespace tss
