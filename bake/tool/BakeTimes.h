#pragma once
#include "bake/tool/Command.h"

#include <map>

namespace tss::tool {

/// Seconds that each pair and skin took to bake, by prim path. They differ from run to run, while the bytes
/// of a scene file are the same on every machine; so they are stored in an extended attribute of the file
/// (user.tss.seconds), and lost where that is not kept.
using BakeTimes = std::map<std::string, double>;

void writeBakeTimes(const std::string& file, const BakeTimes& times);
BakeTimes readBakeTimes(const std::string& file);

/// Fills in "seconds" of the pairs and skins of a summary.
void addTimes(Json& summary, const BakeTimes& times);

} // namespace tss::tool
