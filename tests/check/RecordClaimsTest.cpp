// What a baked file says beside its bounds: figures of the spheres and counts. What the stored table
// contradicts is refused.
#include "bake/check/VerifyPair.h"
#include "bake/pipeline/Bake.h"
#include "tests/pipeline/LumpyPair.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

SceneModel bakedWith(const BakeSettings& settings) {
    SceneModel scene = lumpyPair(3);
    Pair& pair = scene.pairs[0];
    pair.settings = settings;
    pair.settings["tolerance"] = "0.05";
    bake(scene, {});
    REQUIRE(pair.table);
    return scene;
}

/// Why the pair does not hold once its table is changed so; empty: it holds.
template <typename Change>
std::string refusal(const SceneModel& scene, const Change& change) {
    Pair pair = scene.pairs[0];
    auto changed = std::make_shared<Table>(*pair.table);
    change(*changed);
    pair.table = changed;
    return verifyPair(scene, pair).reason;
}

const auto none = [](Table&) {};
using Catch::Contains;

} // namespace

TEST_CASE("a protrusion that a stored sphere goes beyond is refused, for either body") {
    const SceneModel scene = bakedWith({});
    CHECK(refusal(scene, none) == "");
    CHECK_THAT(refusal(scene, [](Table& t) { *t.record.fitA.protrusion *= 0.5; }),
               Contains("of A") && Contains("tss:protrusion"));
    CHECK_THAT(refusal(scene, [](Table& t) { t.record.fitB.protrusion = 0; }),
               Contains("of B") && Contains("tss:protrusion"));
    CHECK(refusal(scene, [](Table& t) { *t.record.fitA.protrusion *= 2; }) == "");
    CHECK(refusal(scene, [](Table& t) { t.record.fitA.protrusion.reset(); }) == "");
}

TEST_CASE("an epsilon less than what tests report beyond their spheres is refused") {
    const SceneModel scene = bakedWith({{"epsilon", "0.03"}});
    REQUIRE(scene.pairs[0].table->epsilon > 0);
    CHECK(refusal(scene, none) == "");
    CHECK_THAT(refusal(scene, [](Table& t) { t.epsilon = 0; }), Contains("tss:epsilon"));
}

TEST_CASE("a coverage less than the miss that it stands for is refused") {
    const SceneModel scene = bakedWith({{"conservative", "false"}});
    const Table& table = *scene.pairs[0].table;
    REQUIRE(table.boundMiss.value_or(0) > 0);
    CHECK(refusal(scene, none) == "");
    CHECK_THAT(refusal(scene, [](Table& t) { t.record.fitA.coverage = 0; }), Contains("tss:coverage"));
}

TEST_CASE("counts that the table itself contradicts are refused") {
    const SceneModel scene = bakedWith({});
    CHECK(scene.pairs[0].table->record.lowerBound > 0);
    CHECK_THAT(refusal(scene, [](Table& t) { t.record.lowerBound = t.testCount() + 1; }),
               Contains("tss:lowerBound"));
    if (scene.pairs[0].table->testCount() > 1)
        CHECK_THAT(refusal(scene, [](Table& t) { t.record.candidatePairs = 1; }),
                   Contains("tss:candidatePairs"));
    CHECK_THAT(refusal(scene, [](Table& t) { t.record.spheresB = t.b.size() - 1; }),
               Contains("tss:generatedSpheres"));
    CHECK(refusal(scene, [](Table& t) { t.record.spheresA = t.record.spheresB = 0; }) == "");
}
