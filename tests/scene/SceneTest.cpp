#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/scene/ReadLayer.h"
#include "bake/scene/SceneFile.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/WriteLayer.h"

#include "tests/scene/Samples.h"

#include <catch2/catch.hpp>

using namespace tss;

TEST_CASE("a model written and read again is the same scene") {
    SceneModel scene = samples::jaw();
    scene.metersPerUnit = 0.001;
    scene.bodies[0].displayName = "bone \"one\"";
    scene.bodies[1].doubleSided = true;
    scene.pairs[0].settings["max-spheres"] = "100";
    scene.joints[0].drives[0] = {{0, 24}, {0, -0.25}};
    const SceneModel back = samples::fromFile(scene);
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
    CHECK((pose(motion, q).matrix() - pose(samples::jawMotion(), q).matrix()).norm() < 1e-6);
}

TEST_CASE("what was rounded once is not rounded again") {
    const Layer once = toLayer(samples::fromFile(samples::jaw()));
    SceneModel second = readScene(once, "");
    second.layer = nullptr;
    CHECK(writeJson(toLayer(second)) == writeJson(once));
}

TEST_CASE("a table comes back number by number") {
    SceneModel scene = samples::fromFile(samples::jaw());
    Table table;
    table.a = {{Vec3(0.5, 0.25, 0), 0.125}, {Vec3(1, 0, 0), 1}};
    table.b = {{Vec3(double(0.1f), 0, 0), double(0.3f) / 2}};
    table.rowOffsets = {0, 1, 2};
    table.columns = {0, 0};
    table.restGaps = {0, -0.1};
    table.restRegion = {{{0, 2}, {2, 1}}, {{1, 5}}, 0.1};
    table.motion = pairMotion(scene, scene.pairs[0]);
    table.epsilon = 1e-9;
    table.boundMiss = 0;
    table.certified = true;
    table.method = "medial/certified/cover";
    table.record.spheresA = 10;
    table.record.fitA.coverage = 0;
    scene.pairs[0].table = std::make_shared<Table>(table);
    scene.pairs[0].sourceHash = "abc";
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
    CHECK(read.restRegion.a == table.restRegion.a);
    CHECK(read.restRegion.b == table.restRegion.b);
    CHECK(read.restRegion.depth == 0.1);
    CHECK(read.epsilon == table.epsilon);
    CHECK(read.boundMiss == 0);
    CHECK_FALSE(read.boundEarly);
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
    SceneModel scene = samples::jaw();
    Table table;
    table.a = {{Vec3(0.1, 0, 0), 1}};
    table.rowOffsets = {0, 0};
    scene.pairs[0].table = std::make_shared<Table>(table);
    CHECK_THROWS_AS(layerOf(scene), std::logic_error);
}

TEST_CASE("a muscle between two bones comes back with both, by the names that it had") {
    SceneModel scene = samples::brow();
    scene.muscles[0].insertionBone = 0;
    const SceneModel back = samples::fromFile(scene);
    CHECK(back.bodies[back.muscles[0].bone].path == "/Scene/Bone");
    REQUIRE(back.muscles[0].insertionBone == 0);
    CHECK(back.muscles[0].muscle.spans);
    const Layer& layer = *back.layer;
    CHECK(writeJson(layer) == writeJson(layerOf(back)));

    scene = back; // and then it moves with one again: both names stay
    scene.muscles[0].insertionBone = -1;
    const SceneModel one = samples::fromFile(scene);
    CHECK(one.muscles[0].bone == back.muscles[0].bone);
    CHECK(one.muscles[0].insertionBone == -1);
    CHECK_FALSE(one.muscles[0].muscle.spans);
}

TEST_CASE("muscles and skins come back as they were") {
    const SceneModel scene = samples::brow();
    const SceneModel back = samples::fromFile(scene);
    REQUIRE(back.muscles.size() == 1);
    const MuscleModel& muscle = back.muscles[0];
    CHECK(muscle.path == "/Scene/Frontalis");
    CHECK(back.bodies[muscle.body].path == "/Scene/Surface");
    CHECK(back.bodies[muscle.bone].path == "/Scene/Bone");
    CHECK(muscle.muscle.fibre == scene.muscles[0].muscle.fibre);
    CHECK(muscle.muscle.form == MuscleForm::Sheet);
    CHECK(muscle.muscle.maxContraction == 0.3);
    CHECK(muscle.activation.at(12) == 0.5);
    CHECK(muscle.muscle.surface.triangles == samples::tetrahedron().triangles);
    REQUIRE(back.skins.size() == 1);
    CHECK(back.skins[0].muscles == std::vector<int>{0});
    CHECK(back.skins[0].thickness == 0.5);
    CHECK(back.skins[0].tether == scene.skins[0].tether);
    CHECK(back.skins[0].selfContact);
    CHECK(back.skins[0].attach.empty());
    CHECK(back.skins[0].settings == scene.skins[0].settings);
}

TEST_CASE("a skin's table comes back number by number") {
    SceneModel scene = samples::fromFile(samples::brow());
    auto table = std::make_shared<SkinTable>();
    table->table.a = {{Vec3(1, 0, 0), 0.5}};
    table->table.b = {{Vec3(0, 0, 0), 0.5}, {Vec3(0, 1, 0), 0.25}};
    table->table.rowOffsets = {0, 2};
    table->table.columns = {0, 1};
    table->skinVertices = {3};
    table->muscleOf = {0, 0};
    table->travel = 0.1;
    scene.skins[0].table = table;
    scene.skins[0].sourceHash = "abc";
    const std::string saved = writeJson(layerOf(scene));
    const SceneModel back = readScene(parseLayer(saved, ""), "");
    REQUIRE(back.skins[0].table);
    CHECK(back.skins[0].table->skinVertices == table->skinVertices);
    CHECK(back.skins[0].table->muscleOf == table->muscleOf);
    CHECK(back.skins[0].table->travel == 0.1);
    CHECK(back.skins[0].table->table.columns == table->table.columns);
    CHECK(back.skins[0].sourceHash == "abc");
    CHECK(writeJson(layerOf(back)) == saved);
}

TEST_CASE("a pair that lost its table has none in the file") {
    SceneModel scene = samples::fromFile(samples::jaw());
    const std::string before = writeJson(layerOf(scene));
    auto proof = std::make_shared<NeverCollides>();
    proof->clearance = 0.5;
    proof->cells = 7;
    scene.pairs[0].proof = proof;
    SceneModel back = readScene(layerOf(scene), "");
    REQUIRE(back.pairs[0].proof);
    CHECK(back.pairs[0].proof->clearance == 0.5);
    CHECK(back.pairs[0].proof->cells == 7);
    back.pairs[0].proof = nullptr;
    CHECK(readScene(layerOf(back), "").pairs[0].proof); // only not loaded
    back.pairs[0].tablePath.clear();
    CHECK(writeJson(layerOf(back)) == before);
}

TEST_CASE("an ordinary hinge needs no key that is not USD's own, and none about skins or muscles") {
    SceneModel scene;
    samples::addBody(scene, "A");
    samples::addBody(scene, "B");
    Motion motion;
    motion.dofs.resize(1);
    motion.dofs[0].upper = 0.5;
    motion.dofs[0].name = "rotX";
    addPair(scene, 0, 1, motion, "Hinge");
    const std::string text = writeJson(toLayer(scene));
    INFO(text);
    CHECK(text.find("PhysicsRevoluteJoint") != std::string::npos);
    CHECK(text.find("tss:") == std::string::npos);
    CHECK(text.find("Skin") == std::string::npos);
    CHECK(text.find("Muscle") == std::string::npos);
    CHECK(text.find("\"subdivisionScheme\"") != std::string::npos);
    CHECK(text.find("\"physics:collisionEnabled\": {\"typeName\": \"bool\", \"default\": true}") !=
          std::string::npos);
}

TEST_CASE("the smallest scene of the documentation is a scene with a pair") {
    const std::string page = readWholeFile(std::string(OSGTSS_SOURCE_DIR) + "/docs/FORMAT.md");
    const auto begin = page.find("```json\n") + 8;
    const std::string text = page.substr(begin, page.find("```", begin) - begin);
    const SceneModel scene = readScene(parseLayer(text, "docs/FORMAT.md"), "docs/FORMAT.md");
    CHECK(scene.bodies.size() == 2);
    REQUIRE(scene.pairs.size() == 1);
    CHECK(pairMotion(scene, scene.pairs[0]).dofs[0].upper == Approx(1.7453).epsilon(1e-4));
}

TEST_CASE("a rest beyond the limits of a path over time stamps is not taken for one within them") {
    SceneModel scene = samples::jaw();
    Dof path;
    path.name = "path";
    path.kind = DofKind::Path;
    path.lower = path.rest = 1.7e9;
    path.upper = 1.7e9 + 50;
    path.path = {{path.lower, Vec3::Zero(), {}}, {path.upper, Vec3::UnitX(), {}}};
    for (PathRow& row : path.path) row.rotation.setIdentity();
    scene.joints[0].dofs = {path};
    scene.joints[0].drives.resize(1);
    scene.joints[0].planes.clear();
    const auto restRead = [&](double rest) {
        scene.joints[0].dofs[0].rest = rest;
        return samples::fromFile(scene).joints[0].dofs[0].rest;
    };
    CHECK(restRead(path.upper) == path.upper);
    CHECK_THROWS_AS(restRead(path.upper + 100), InputError);
}

TEST_CASE("limits that leave no pose are told with the joint, and a rest not given lies within the limits") {
    SceneModel scene = samples::jaw();
    scene.joints[0].planes = {{{1, 0}, 3}, {{0, 1}, -1.5}}; // lateral is at least -1
    try {
        samples::fromFile(scene);
        FAIL("read all the same");
    } catch (const InputError& error) {
        CHECK(error.where.path == scene.joints[0].path);
        CHECK(error.message.find("limit plane 2 of the DOFs 'open', 'lateral'") != std::string::npos);
    }
    scene = samples::jaw();
    scene.joints[0].dofs[0].lower = 0.1;
    scene.joints[0].dofs[0].rest = 0.05;
    CHECK_THROWS_AS(samples::fromFile(scene), InputError);
    Layer layer = toLayer(scene);
    Prim* joint = findPrim(layer, scene.joints[0].path);
    REQUIRE(joint);
    REQUIRE(joint->properties.erase("tss:rest") == 1);
    CHECK(readScene(layer, "test.tss").joints[0].dofs[0].rest == Approx(0.1));
}
