#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

#include <map>
#include <string>

namespace tss::tool {

/// What scripts read of a pair or a skin (DESIGN "the command line"). Unknown figures are null.
Json summary(const SceneModel& scene, const Pair& pair);
Json summary(const SceneModel& scene, const SkinModel& skin);

/// pairs[] and skins[] of a scene.
Json summary(const SceneModel& scene);

/// The same for people, one block a pair.
std::string describe(const Json& summaryOfScene);

/// Seconds of each bake by prim path. They belong to a run and not to the scene, whose bytes are the same on
/// every machine; so they stand in an extended attribute of the file (user.tss.seconds) and get lost where
/// that is not kept.
using BakeTimes = std::map<std::string, double>;

void writeBakeTimes(const std::string& file, const BakeTimes& times);
BakeTimes readBakeTimes(const std::string& file);

/// Fills "seconds" of the pairs and skins of a summary.
void addTimes(Json& summary, const BakeTimes& times);

} // namespace tss::tool
