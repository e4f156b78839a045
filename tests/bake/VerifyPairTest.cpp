#include "bake/VerifyPair.h"

#include "bake/Bake.h"
#include "bake/base/Error.h"
#include "bake/scene/AddPair.h"
#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

TEST_CASE("a verification that is stopped says so, wherever it is") {
    std::mt19937_64 random(5);
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Scene";
    for (const char* name : {"A", "B"}) {
        Body body;
        body.path = std::string("/Scene/") + name;
        body.mesh = lumpyMesh(random, 2, 0.3);
        if (!scene.bodies.empty())
            body.mesh = transformed(body.mesh, Eigen::Affine3d(Eigen::Translation3d(2.6, 0, 0)));
        scene.bodies.push_back(body);
    }
    Motion motion;
    motion.dofs = {joints::turn({1.3, 3, 0}, {0, 0, 1}, -0.5, 0.5)};
    scene.pairs[addPair(scene, 0, 1, motion, "Swing")].settings["tolerance"] = "0.02";
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
