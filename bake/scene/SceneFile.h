#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/Layer.h"
#include "bake/scene/ReadTree.h"

#include <functional>

namespace tss {

/// Reads a scene file. Throws InputError with file, JSON pointer, prim or property path and what was
/// expected; never leaves half a scene.
SceneModel loadScene(const std::string& file);

/// Writes the scene: into a copy of the layer that it was read from, of which only tables, proofs and hashes
/// change; or a whole new layer when there is none. The file is whole or not written. Throws InputError.
void saveScene(const SceneModel& scene, const std::string& file);

/// The layer that saveScene() writes.
Layer layerOf(const SceneModel& scene);

/// Everything wrong with a scene file, stale tables too, and not only the first thing; empty for a good one.
/// What only deserves a warning goes to `warnings` when given.
/// more: looks for what else is wrong with a scene that reads well, each with its prim's path.
std::vector<LocatedError>
validateScene(const std::string& file, std::vector<LocatedError>* warnings = nullptr,
              const std::function<std::vector<InputError>(const SceneModel&)>& more = {});

} // namespace tss
