#include "bake/model/AddPair.h"
#include "bake/pipeline/BakeSkin.h"
#include "bake/pipeline/CheckBake.h"
#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

/// Two balls as bones in a larger one, the skin.
SceneModel headScene() {
    SceneModel scene;
    for (const char* path : {"/Head/Skull", "/Head/Jaw", "/Head/Skin"}) {
        Body body;
        body.path = path;
        body.mesh =
            ballMesh(Vec3(0, scene.bodies.size() == 1 ? 2.5 : 0, 0), scene.bodies.size() < 2 ? 1 : 4, 2);
        scene.bodies.push_back(body);
    }
    SkinModel skin;
    skin.path = "/Head/Skin";
    skin.body = 2;
    skin.bones = {0, 1};
    scene.skins = {skin};
    return scene;
}

} // namespace

TEST_CASE("a joint that turns a skin's bones farther than half round is named") {
    const auto noted = [](double upper) {
        SceneModel scene;
        for (const char* path : {"/Limb/A", "/Limb/B", "/Limb/Skin"}) {
            Body body;
            body.path = path;
            const double x = scene.bodies.size() == 1 ? 2 : 0;
            body.mesh = ballMesh(Vec3(x, 0, 0), scene.bodies.size() < 2 ? 0.9 : 4, 2);
            scene.bodies.push_back(body);
        }
        Motion motion;
        motion.dofs = {joints::turn(Vec3::Zero(), Vec3::UnitX(), -1, upper)};
        addJoints(scene, 0, 1, motion, "Twist");
        SkinModel skin;
        skin.path = "/Limb/Skin";
        skin.body = 2;
        skin.bones = {0, 1};
        scene.skins = {skin};
        PairReport report;
        bakeSkin(scene, scene.skins[0], {}, report, {});
        return std::ranges::any_of(report.notes, [](const std::string& note) {
            return note.find("Twist turns bones by more than half a turn") != note.npos;
        });
    };
    CHECK(noted(6));
    CHECK_FALSE(noted(3.1));
}

TEST_CASE("what is said of the mesh of one of a skin's bones names that bone") {
    SceneModel scene = headScene();
    scene.bodies[1].mesh.triangles.pop_back(); // the jaw is open
    PairReport report;
    fillMuscles(scene, scene.skins[0], {}, report);
    REQUIRE(report.notes.size() == 1);
    CHECK(report.notes[0].find("/Head/Jaw: 3 open or misoriented edges") == 0);
}

TEST_CASE("a tolerance that is too fine for what lies under a skin is made coarser there, and said") {
    SceneModel scene;
    for (const char* path : {"/Head/Skull", "/Head/Skin"}) {
        Body body;
        body.path = path;
        body.mesh = ballMesh(Vec3::Zero(), scene.bodies.empty() ? 1 : 4, 3);
        scene.bodies.push_back(body);
    }
    SkinModel skin;
    skin.path = "/Head/Skin";
    skin.body = 1;
    skin.bones = {0};
    PairReport report;
    BakeOptions options;
    options.tolerance = 1e-5;
    const FilledMuscles filled = fillMuscles(scene, skin, options, report);
    REQUIRE(report.notes.size() == 1);
    CHECK_THAT(report.notes[0], Catch::StartsWith("/Head/Skull: a tolerance of ") &&
                                    Catch::Contains("which takes too many patches"));
    CHECK(filled.searched[0].spheres.size() > 10);
}

TEST_CASE(
    "a skin of nonsensical thickness, or over a bone without area, is refused before anything is made") {
    SceneModel scene = headScene();
    CHECK(refusedByBake(scene, {}).empty());
    scene.skins[0].thickness = 1e30;
    REQUIRE(refusedByBake(scene, {}).size() == 1);
    CHECK(std::string(refusedByBake(scene, {})[0].what()).find("a hundred times its size") !=
          std::string::npos);
    scene.skins[0].thickness = 0;
    scene.bodies[1].mesh = {{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, {Tri(0, 1, 2)}};
    REQUIRE(refusedByBake(scene, {}).size() == 1);
    CHECK(refusedByBake(scene, {})[0].where.path == "/Head/Jaw");
}
