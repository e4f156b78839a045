#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

struct Layer;

/// Reads a scene file. Throws InputError with file, JSON pointer, prim or property path and what was
/// expected; never leaves half a scene.
SceneModel loadScene(const std::string& file);

/// Writes the scene: into a copy of the layer that it was read from, of which only tables, proofs and hashes
/// change, not meshes, joints or new prims; or a whole new layer when there is none (SceneModel::layer null,
/// as one sets it whose program changed those: what only the layer knew is not written then). The file is
/// whole or not written. Throws InputError, also for a scene that loadScene() would refuse.
void saveScene(const SceneModel& scene, const std::string& file);

/// The layer that saveScene() writes.
Layer layerOf(const SceneModel& scene);

} // namespace tss
