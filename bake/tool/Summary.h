#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// What scripts read of a pair or a skin (DESIGN "the command line"). Unknown figures are null.
Json summary(const SceneModel& scene, const Pair& pair);
Json summary(const SceneModel& scene, const SkinModel& skin);

/// pairs[] and skins[] of a scene.
Json summary(const SceneModel& scene);

/// The same for people, one block a pair.
std::string describe(const Json& summaryOfScene);

} // namespace tss::tool
