// Baked files damaged in every way that comes to mind: what verify lets pass may not miss what it says it
// does not.
#include "tests/adversary/scenes/FileDamage.h"
#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/check/VerifyPair.h"
#include "bake/model/SourceHash.h"
#include "bake/pipeline/Bake.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/WriteLayer.h"
#include "tests/adversary/judge/Attack.h"
#include "tests/adversary/judge/Trial.h"
#include "tests/adversary/scenes/Draws.h"

#include <catch2/catch.hpp>
#include <ctime>
#include <fmt/format.h>

using namespace adversary;

namespace {

struct BakedText {
    std::string text, name;
    double length = 0;
};

/// Says no after some seconds of processor time: a damaged table may take the verifier long, and what it has
/// not proven by then it has not let pass.
tss::Progress inTime() {
    const std::clock_t until = std::clock() + 2 * CLOCKS_PER_SEC;
    return [until](std::string_view, double) { return std::clock() < until; };
}

/// A scene with a table of several kinds of settings; which, goes by the number.
BakedText bakedText(std::size_t number) {
    Draft (*const draws[])(std::uint64_t) = {components, overlaps, plates,  sockets,   chains,
                                             cracks,     needles,  farAxes, fullTurns, units};
    const bool atRest = number % 10 == 1 || number % 10 == 3;
    for (std::uint64_t seed = 100 * number;; ++seed) {
        REQUIRE(seed < 100 * number + 100);
        Draft draft = draws[number % 10](seed);
        const auto length = [&](double l) { return fmt::format("{}", l * draft.tolerance * draft.unit); };
        draft.settings.clear();
        if (!atRest) draft.settings["at-rest"] = "collide";
        if (number % 2) draft.settings["keep-spheres"] = "true";
        if (number % 3 == 1) draft.settings["depth"] = length(1.5);
        if (number % 4 == 2) draft.settings["epsilon"] = length(0.2);
        if (number % 7 == 3) draft.settings["conservative"] = "false";
        try {
            tss::SceneModel scene = sceneOf(draft, "scene");
            tss::bake(scene, {});
            const tss::Pair& pair = scene.pairs[0];
            if (!pair.table || !pair.table->certified || !pair.table->boundMiss ||
                pair.table->testCount() < 3)
                continue;
            if (!tss::verifyPair(scene, pair, inTime()).holds()) continue; // another test's concern
            return {tss::writeJson(tss::layerOf(scene)), fmt::format("{} with seed {}", number, seed),
                    draft.tolerance * draft.unit};
        } catch (const tss::InputError&) {
            continue;
        }
    }
}

struct Count {
    int tried = 0, unreadable = 0, refused = 0, harmless = 0;
};

void damageTable(std::size_t number, std::uint64_t poses, std::vector<Count>& counts) {
    const BakedText baked = bakedText(number);
    for (std::size_t kind = 0; kind < damages().size(); ++kind) {
        const std::string text = damaged(baked.text, kind, baked.length, number + 1);
        if (text.empty()) continue;
        Count& count = counts[kind];
        ++count.tried;
        INFO("table " << baked.name << ": " << damages()[kind].name);
        try {
            tss::SceneModel scene = extreme::readText(text, "damaged");
            tss::Pair& pair = scene.pairs.at(0);
            if (damages()[kind].hashed) pair.sourceHash = tss::sourceHash(scene, pair);
            if (!tss::verifyPair(scene, pair, inTime()).holds()) {
                ++count.refused;
                continue;
            }
            ++count.harmless;
            const Findings found = attackPair(scene, pair, {poses, number + 1});
            if (found.failed()) FAIL_CHECK("verify lets pass: " << found.what);
        } catch (const tss::InputError&) {
            ++count.unreadable;
        }
    }
}

void damageTables(std::size_t tables, std::uint64_t poses) {
    const tss::ThreadLimit one(1);
    std::vector<Count> counts(damages().size());
    for (std::size_t number = 0; number < tables; ++number) damageTable(number, poses, counts);
    std::string text;
    int tried = 0, kept = 0;
    for (std::size_t kind = 0; kind < counts.size(); ++kind) {
        const Count& c = counts[kind];
        tried += c.tried > 0;
        kept += c.refused + c.unreadable;
        text += fmt::format("{:>3} tried {:>3} not readable {:>3} refused {:>3} passed  {}\n", c.tried,
                            c.unreadable, c.refused, c.harmless, damages()[kind].name);
    }
    WARN(text);
    CHECK(tried >= 50);
    CHECK(kept > 0);
}

} // namespace

TEST_CASE("damaged files of two tables: none passes verify that misses what it says it does not") {
    damageTables(2, 300);
}

TEST_CASE("damaged files of twenty tables: none passes verify that misses what it says it does not",
          "[.long]") {
    damageTables(20, 3000);
}
