#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/Problems.h"

namespace tss {

/// The typed view of a layer. The scene keeps a copy of the layer. Throws InputError, with file, JSON
/// pointer, path and what was expected, at the first thing wrong.
SceneModel readScene(const Layer& layer, const std::string& fileName);
SceneModel readScene(std::shared_ptr<const Layer> layer, const std::string& fileName);

/// The same into `problems`, which may collect; what is wrong is left out of the scene.
SceneModel readScene(std::shared_ptr<const Layer> layer, Problems& problems);

} // namespace tss
