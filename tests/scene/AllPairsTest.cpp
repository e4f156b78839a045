#include "bake/scene/AllPairs.h"
#include "bake/scene/SceneFile.h"
#include "tests/scene/Samples.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;

namespace {

Motion hinge(const Vec3& origin) {
    Motion motion;
    Dof dof;
    dof.name = "turn";
    dof.origin = origin;
    dof.axis = Vec3::UnitZ();
    dof.lower = -0.5;
    dof.upper = 0.5;
    motion.dofs = {dof};
    return motion;
}

/// A leg: pelvis, thigh, shank and foot, a hinge between each two; pairs for the neighbours `named` only.
SceneModel leg(int named = 0) {
    SceneModel scene;
    for (const char* name : {"Pelvis", "Thigh", "Shank", "Foot"}) samples::addBody(scene, name);
    for (int k = 0; k < 3; ++k) addPair(scene, k, k + 1, hinge(Vec3(k, 0, 0)), "Joint" + std::to_string(k));
    scene.pairs.resize(static_cast<std::size_t>(named));
    return scene;
}

std::vector<std::string> pathsOf(const SceneModel& scene) {
    std::vector<std::string> paths;
    for (const Pair& pair : scene.pairs) paths.push_back(pair.path);
    return paths;
}

} // namespace

TEST_CASE("a pass over all bodies makes pairs of neighbours and over chains of joints") {
    SceneModel scene = leg();
    const AllPairs found = addAllPairs(scene);
    CHECK(found.unmade.empty());
    CHECK(found.added == std::vector<std::string>{"/Scene/Joint0", "/Scene/Pelvis_Shank",
                                                  "/Scene/Pelvis_Foot", "/Scene/Joint1", "/Scene/Thigh_Foot",
                                                  "/Scene/Joint2"});
    const int chain = findPair(scene, "/Scene/Pelvis_Foot");
    REQUIRE(chain >= 0);
    CHECK(pairMotion(scene, scene.pairs[chain]).dofCount() == 3);
    CHECK(addAllPairs(scene).added.empty()); // once is enough
}

TEST_CASE("pairs that a scene has already stay as they are") {
    SceneModel scene = leg(1);
    scene.pairs[0].settings["tolerance"] = "0.1";
    CHECK(addAllPairs(scene).added.size() == 5);
    CHECK(scene.pairs.size() == 6);
    CHECK(scene.pairs[0].settings.at("tolerance") == "0.1");
}

TEST_CASE("the pairs found are in the scene that is read from a file, and in the file that it is saved to") {
    SceneModel built = leg(1);
    Layer layer = toLayer(built);
    SceneModel scene = readScene(std::make_shared<const Layer>(layer), "leg.tss");
    const AllPairs found = addAllPairs(scene);
    CHECK(found.added.size() == 5);
    const SceneModel again = readScene(std::make_shared<const Layer>(layerOf(scene)), "leg.tss");
    REQUIRE(again.pairs.size() == 6);
    auto before = pathsOf(scene), after = pathsOf(again);
    std::sort(before.begin(), before.end());
    std::sort(after.begin(), after.end());
    CHECK(before == after);
    for (const Pair& pair : again.pairs) {
        const Pair& same = scene.pairs[std::size_t(findPair(scene, pair.path))];
        CHECK(same.bodyA == pair.bodyA);
        CHECK(same.bodyB == pair.bodyB);
        CHECK(same.joints == pair.joints);
    }
}

TEST_CASE("what cannot collide or cannot be baked is no pair, and the notes say why") {
    SceneModel scene = leg();
    scene.joints[0].collisionEnabled = false; // pelvis and thigh
    scene.joints[2].dofs[0].upper = std::numeric_limits<double>::infinity();
    AllPairs found = addAllPairs(scene);
    CHECK(found.added == std::vector<std::string>{"/Scene/Pelvis_Shank", "/Scene/Joint1"});
    CHECK(found.unmade.size() == 3); // everything against the foot

    scene = leg();
    Joint loop = scene.joints[0];
    loop.path = "/Scene/Loop";
    loop.body0 = 0;
    loop.body1 = 3;
    scene.joints.push_back(loop);
    found = addAllPairs(scene);
    CHECK(found.added.empty());
    REQUIRE(found.unmade.size() == 6);
    CHECK(found.unmade[0].note.find("closed loop") != std::string::npos);

    scene = leg();
    scene.joints[1].enabled = false; // two halves that nothing holds together
    CHECK(addAllPairs(scene).added == std::vector<std::string>{"/Scene/Joint0", "/Scene/Joint2"});

    SceneModel brow = samples::brow();
    CHECK(addAllPairs(brow).added.empty());
}
