#include "bake/pipeline/BakeSkin.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

TEST_CASE("what is said of the mesh of one of a skin's bones names that bone") {
    SceneModel scene;
    for (const char* path : {"/Head/Skull", "/Head/Jaw", "/Head/Skin"}) {
        Body body;
        body.path = path;
        body.mesh = ballMesh(Vec3(0, scene.bodies.size() == 1 ? 2.5 : 0, 0), scene.bodies.size() < 2 ? 1 : 4, 2);
        scene.bodies.push_back(body);
    }
    scene.bodies[1].mesh.triangles.pop_back(); // the jaw is open
    SkinModel skin;
    skin.path = "/Head/Skin";
    skin.body = 2;
    skin.bones = {0, 1};
    PairReport report;
    fillMuscles(scene, skin, {}, report);
    REQUIRE(report.notes.size() == 1);
    CHECK(report.notes[0].find("/Head/Jaw: 3 open or misoriented edges") == 0);
}
