#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

#include <map>
#include <string>

namespace tss::tool {

/// The data of a pair or a skin for scripts (docs/TSS.md, --json). Unknown figures are null.
Json summary(const SceneModel& scene, const Pair& pair);
Json summary(const SceneModel& scene, const SkinModel& skin);

/// pairs[] and skins[] of a scene.
Json summary(const SceneModel& scene);

/// The same for people, one block a pair.
std::string describe(const Json& summaryOfScene);

/// Seconds of each bake by prim path. They differ from run to run, while the bytes of a scene file are the
/// same on every machine; so they are stored in an extended attribute of the file (user.tss.seconds), and
/// lost where that is not kept.
using BakeTimes = std::map<std::string, double>;

void writeBakeTimes(const std::string& file, const BakeTimes& times);
BakeTimes readBakeTimes(const std::string& file);

/// Fills "seconds" of the pairs and skins of a summary.
void addTimes(Json& summary, const BakeTimes& times);

} // namespace tss::tool
