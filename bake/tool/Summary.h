#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

#include <map>

namespace tss::tool {

/// The data of a scene's pairs and skins for scripts (docs/TSS.md, --json): pairs[] and skins[]. Unknown
/// figures are null.
Json summary(const SceneModel& scene);

/// The summary of a scene for people: one block of lines for each pair and skin (docs/TSS.md,
/// section 2, has what each line says).
std::string describe(const Json& summaryOfScene);

/// How much of either surface a pair's bounds are about: of 1, what is not exempt (METHOD 2.4). Contact of
/// such a part with anything of the other body is bounded.
struct BoundedShares {
    double a = 1, b = 1;

    /// All of both surfaces is exempt from contact with the other: the bounds are about nothing.
    bool none() const { return a <= 0 && b <= 0; }
};

/// From the shares that are exempt. What is left by rounding alone is nothing.
BoundedShares boundedShares(double exemptA, double exemptB);

/// For people, of pairs with exempt parts: "37.5 % of A and over 99.9 % of B". Rounded down, so that no
/// more is promised than holds.
std::string boundedText(const BoundedShares& bounded);

/// Seconds that each pair and skin took to bake, by prim path. They differ from run to run, while the bytes
/// of a scene file are the same on every machine; so they are stored in an extended attribute of the file
/// (user.tss.seconds), and lost where that is not kept.
using BakeTimes = std::map<std::string, double>;

void writeBakeTimes(const std::string& file, const BakeTimes& times);
BakeTimes readBakeTimes(const std::string& file);

/// Fills in "seconds" of the pairs and skins of a summary.
void addTimes(Json& summary, const BakeTimes& times);

} // namespace tss::tool
