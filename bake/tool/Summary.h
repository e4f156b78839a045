#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// The data of a scene's pairs and skins for scripts (docs/TSS.md, --json): pairs[] and skins[]. Unknown
/// figures are null.
Json summary(const SceneModel& scene);

/// The summary of a scene for people: one block of lines for each pair and skin (docs/TSS.md,
/// section 2, has what each line says).
std::string describe(const Json& summaryOfScene);

} // namespace tss::tool
