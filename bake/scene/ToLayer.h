#pragma once
#include "bake/model/SceneModel.h"
#include "bake/scene/Layer.h"

namespace tss {

/// A complete layer of the scene, for a scene that was not read from one: bodies, joints, pairs, muscles,
/// skins and their tables. What the file stores as float is rounded to float, so bake from
/// readScene(toLayer(scene)). Throws InputError for what cannot be written, such as a path that is no prim
/// path or a DOF off the axes of its joint's frame.
Layer toLayer(const SceneModel& scene);

} // namespace tss
