#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/Layer.h"

namespace tss {

/// Puts the tables, proofs and hashes of the scene's pairs and skins into a layer of the same scene, and
/// leaves everything else of it as it is. A pair or skin with neither table nor proof keeps what the layer
/// has while it names a tablePath, and loses it when it names none. Throws InputError when the layer has no
/// prim for a pair or skin, and std::logic_error for spheres that are not exact in float.
void storeTables(Layer& layer, const SceneModel& scene);

} // namespace tss
