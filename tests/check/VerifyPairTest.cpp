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

TEST_CASE("a verification that is stopped while it makes spheres again says so, and throws nothing") {
    SceneModel scene = lumpyPair(5);
    std::mt19937_64 random(5);
    // Overlapping at rest, with triangles enough there for a look at Progress among them.
    scene.bodies[0].mesh =
        transformed(lumpyMesh(random, 5, 0.1), Eigen::Affine3d(Eigen::Translation3d(0.7, 0, 0)));
    scene.pairs[0].settings = {{"tolerance", "0.1"}, {"depth", "0.1"}};
    bake(scene, {});
    REQUIRE(scene.pairs[0].table);
    bool stopped = false;
    const Progress stop = [&](std::string_view step, double done) {
        stopped = stopped || (step == "patches" && done == 0);
        return !stopped;
    };
    CHECK(verifyPair(scene, scene.pairs[0], stop).reason == "stopped before its spheres were made again");
    CHECK(stopped);
}
