#include "bake/base/Error.h"
#include "bake/scene/AddPair.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/ReadScene.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/ToLayer.h"
#include "bake/scene/WriteLayer.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace tss;

namespace {

TriangleMesh tetrahedron() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    return mesh;
}

SceneModel twoBodies() {
    SceneModel scene;
    for (const char* name : {"A", "B"}) {
        Body body;
        body.path = std::string("/Scene/") + name;
        body.mesh = tetrahedron();
        scene.bodies.push_back(body);
    }
    return scene;
}

SceneModel reread(const SceneModel& scene) {
    return readScene(toLayer(scene), "test.tss");
}

Motion jawMotion() {
    Motion motion;
    Dof open, lateral;
    open.name = "open";
    open.origin = {0.3, 0, 0.7};
    open.axis = Vec3::UnitY();
    open.lower = -0.3;
    open.upper = 0.4;
    lateral.name = "lateral";
    lateral.kind = DofKind::Translation;
    lateral.axis = {0, 0.002, 0};
    lateral.lower = -1;
    lateral.upper = 1;
    motion.dofs = {open, lateral};
    return motion;
}

} // namespace

TEST_CASE("a model written and read again is the same scene") {
    SceneModel scene = twoBodies();
    scene.metersPerUnit = 0.001;
    scene.bodies[0].displayName = "bone \"one\"";
    scene.bodies[1].doubleSided = true;
    const int pair = addPair(scene, 0, 1, jawMotion(), "Jaw");
    scene.pairs[pair].settings["max-spheres"] = "100";
    scene.joints[0].drives[0] = {{0, 24}, {0, -0.25}};
    const SceneModel back = reread(scene);
    REQUIRE(back.bodies.size() == 2);
    CHECK(back.metersPerUnit == 0.001);
    CHECK(back.upAxis == 'Z');
    CHECK(back.bodies[0].displayName == "bone \"one\"");
    CHECK(back.bodies[0].rigid);
    CHECK(back.bodies[1].doubleSided);
    CHECK(back.bodies[1].mesh.triangles == scene.bodies[1].mesh.triangles);
    REQUIRE(back.pairs.size() == 1);
    CHECK(back.pairs[0].settings == scene.pairs[0].settings);
    const Motion motion = pairMotion(back, back.pairs[0]);
    REQUIRE(motion.dofs.size() == 2);
    CHECK(motion.dofs[0].name == "open");
    CHECK(motion.dofs[1].name == "lateral");
    CHECK(motion.dofs[1].lower == Approx(-1));
    CHECK(motion.dofs[0].upper == Approx(0.4));
    CHECK(back.joints[0].drives[0].at(24) == Approx(-0.25));
    const std::vector<double> q = {0.2, 0.5};
    CHECK((pose(motion, q).matrix() - pose(jawMotion(), q).matrix()).norm() < 1e-6);
}

TEST_CASE("what was rounded once is not rounded again") {
    SceneModel scene = twoBodies();
    addPair(scene, 0, 1, jawMotion(), "Jaw");
    const Layer once = toLayer(reread(scene));
    SceneModel second = readScene(once, "");
    second.layer = nullptr;
    CHECK(writeJson(toLayer(second)) == writeJson(once));
}

TEST_CASE("a table comes back number by number") {
    SceneModel scene = twoBodies();
    const int pair = addPair(scene, 0, 1, jawMotion(), "Jaw");
    scene = reread(scene);
    Table table;
    table.a = {{Vec3(0.5, 0.25, 0), 0.125}, {Vec3(1, 0, 0), 1}};
    table.b = {{Vec3(double(0.1f), 0, 0), double(0.3f) / 2}};
    table.rowOffsets = {0, 1, 2};
    table.columns = {0, 0};
    table.restGaps = {0, -0.1};
    table.motion = pairMotion(scene, scene.pairs[pair]);
    table.epsilon = 1e-9;
    table.boundMiss = 0;
    table.certified = true;
    table.method = "medial/certified/cover";
    table.record.spheresA = 10;
    table.record.fitA.coverage = 0;
    scene.pairs[pair].table = std::make_shared<Table>(table);
    scene.pairs[pair].sourceHash = "abc";
    const Layer layer = layerOf(scene);
    const SceneModel back = readScene(parseLayer(writeJson(layer), ""), "");
    REQUIRE(back.pairs[0].table);
    const Table& read = *back.pairs[0].table;
    CHECK(back.pairs[0].sourceHash == "abc");
    CHECK(back.pairs[0].tablePath == "/Scene/Jaw/Table");
    CHECK(read.a[0].centre == table.a[0].centre);
    CHECK(read.b[0].radius == table.b[0].radius);
    CHECK(read.rowOffsets == table.rowOffsets);
    CHECK(read.columns == table.columns);
    CHECK(read.restGaps == table.restGaps);
    CHECK(read.epsilon == table.epsilon);
    CHECK(read.boundMiss == 0);
    CHECK(read.boundEarly == -1);
    CHECK(read.certified);
    CHECK(read.method == table.method);
    CHECK(read.record.spheresA == 10);
    for (int k = 0; k < 2; ++k) {
        CHECK(read.motion.dofs[k].lower == table.motion.dofs[k].lower);
        CHECK(read.motion.dofs[k].upper == table.motion.dofs[k].upper);
    }
    CHECK(writeJson(layerOf(back)) == writeJson(layer));
}

TEST_CASE("spheres that a file cannot hold exactly are not stored") {
    SceneModel scene = twoBodies();
    const int pair = addPair(scene, 0, 1, jawMotion(), "Jaw");
    Table table;
    table.a = {{Vec3(0.1, 0, 0), 1}};
    table.rowOffsets = {0, 0};
    scene.pairs[pair].table = std::make_shared<Table>(table);
    CHECK_THROWS_AS(layerOf(scene), std::logic_error);
}
