#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/ReadTree.h"

#include <functional>

namespace tss {

/// Everything wrong with a scene file, stale tables too, and not only the first thing; empty for a good one.
/// What only deserves a warning goes to `warnings` when given.
/// more: looks for what else is wrong with a scene that reads well, each with its prim's path.
std::vector<LocatedError>
validateScene(const std::string& file, std::vector<LocatedError>* warnings = nullptr,
              const std::function<std::vector<InputError>(const SceneModel&)>& more = {});

} // namespace tss
