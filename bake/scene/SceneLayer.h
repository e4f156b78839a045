#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"

namespace tss {

/// The typed view of a layer. The scene keeps a copy of the layer. Throws InputError, with file, JSON
/// pointer, path and what was expected, at the first thing wrong.
SceneModel readScene(const Layer& layer, const std::string& fileName);
SceneModel readScene(std::shared_ptr<const Layer> layer, const std::string& fileName);

/// The same into `problems`, which may collect; what is wrong is left out of the scene.
SceneModel readScene(std::shared_ptr<const Layer> layer, Problems& problems);

/// A complete layer of the scene, for a scene that was not read from one: bodies, joints, pairs, muscles,
/// skins and their tables. What the file stores as float is rounded to float, so bake from
/// readScene(toLayer(scene)). Throws InputError for what cannot be written, such as a path that is no prim
/// path or a DOF off the axes of its joint's frame.
Layer toLayer(const SceneModel& scene);

} // namespace tss
