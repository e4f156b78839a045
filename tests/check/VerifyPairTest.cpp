#include "bake/check/VerifyPair.h"

#include "bake/base/Error.h"
#include "bake/pipeline/Bake.h"
#include "tests/pipeline/LumpyPair.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

TEST_CASE("a verification that is stopped says so, wherever it is") {
    SceneModel scene = lumpyPair(5);
    scene.pairs[0].settings["tolerance"] = "0.02";
    bake(scene, {});
    const Pair& pair = scene.pairs[0];

    int calls = 0;
    const Progress count = [&](std::string_view, double) { return ++calls > 0; };
    REQUIRE(verifyPair(scene, pair, count).reason.empty());
    REQUIRE(calls > 4);
    for (const int at : {1, 2, calls / 2, calls}) {
        int left = at;
        const Progress stop = [&](std::string_view, double) { return --left > 0; };
        std::string said;
        try {
            said = verifyPair(scene, pair, stop).reason;
        } catch (const InputError& error) {
            said = error.what();
        }
        INFO("stopped at call " << at << " of " << calls << ": " << said);
        CHECK(said.find("stopped") != std::string::npos);
    }
}
