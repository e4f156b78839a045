#include "bake/base/AtomicFile.h"
#include "bake/play/SkinSetup.h"
#include "bake/report/Text.h"
#include "tests/report/Arm.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace tss;
using namespace tss::reporting;

namespace {

TriangleMesh ovalMesh(double centre, double width, double length) {
    TriangleMesh mesh = ballMesh({0, 0, 0}, 1, 3);
    for (Vec3& v : mesh.vertices) v = {centre + length * v.x(), width * v.y(), width * v.z()};
    return mesh;
}

/// A skin over two bones of an elbow.
SceneModel elbowScene() {
    SceneModel scene;
    scene.defaultPrim = "Limb";
    scene.metersPerUnit = 0.01;
    const auto body = [&](const std::string& name, const TriangleMesh& mesh, bool rigid) {
        Body part;
        part.path = "/Limb/" + name;
        part.mesh = mesh;
        part.rigid = rigid;
        scene.bodies.push_back(part);
    };
    body("Upper", ovalMesh(-1.1, 0.3, 1), true);
    body("Lower", ovalMesh(1.1, 0.3, 1), true);
    body("Sleeve", ovalMesh(0, 0.6, 2.6), false);
    Dof bend;
    bend.name = "bend";
    bend.axis = Vec3::UnitY();
    bend.upper = 1.2;
    Motion motion;
    motion.dofs = {bend};
    addPair(scene, 0, 1, motion, "Elbow");
    scene.pairs.clear(); // the skin alone
    SkinModel skin;
    skin.path = "/Limb/Sleeve";
    skin.body = 2;
    skin.bones = {0, 1};
    scene.skins.push_back(skin);
    return scene;
}

} // namespace

TEST_CASE("the report of a skin on bones alone bends them, and speaks of no muscle") {
    const OutFolder folder;
    const Report report = makeReport(elbowScene(), "limb.tss", folder.path, quickOptions());
    REQUIRE(report.skins.size() == 1);
    const SkinStudy& study = report.skins[0];
    CHECK(study.partCount() == "2 bones");
    CHECK(study.motion.bones);
    CHECK(study.motion.farthestMove > 0.5);
    for (const SkinAnswer& answer : study.motion.answers) CHECK(answer.nanoseconds > 0);
    CHECK(study.activations == 1);
    const std::string text = readWholeFile(folder.path + "/report.md");
    CHECK_THAT(text, Catch::Contains("vertices over 2 bones") && Catch::Contains("carried by its bones") &&
                         Catch::Contains("each joint value from one limit to the other"));
    CHECK_THAT(text,
               !Catch::Contains("muscle") && !Catch::Contains("activation") && !Catch::Contains(" 0 ns"));
    CHECK_THAT(text, !Catch::Contains("moving body")); // which is of pairs
    for (const Plot& plot : report.skinPlots[0]) CHECK(plot.file.find("steps") == std::string::npos);
    const auto json = nlohmann::json::parse(readWholeFile(folder.path + "/report.json"))["skins"][0];
    CHECK(json["muscles"] == 0);
    CHECK(json["bones"] == 2);
    CHECK(json["below"] == "2 bones");
}

TEST_CASE("a skin is judged along the joints of the scene's own animation") {
    const OutFolder folder;
    SceneModel scene = elbowScene();
    scene.endTimeCode = 10;
    TimeSamples drive;
    drive.times = {0, 10};
    drive.values = {0, 0.6};
    scene.joints[0].drives = {drive};
    const Report report = makeReport(scene, "limb.tss", folder.path, quickOptions());
    CHECK(report.skins[0].motion.motion == "the scene's own animation");
    CHECK(report.skins[0].motion.bones);
    CHECK(report.skins[0].motion.farthestMove > 0.2);
}

TEST_CASE(
    "of a joint without limits a turn goes half way round, and a slide stays, as its skin's table has it") {
    SceneModel scene = elbowScene();
    Dof& dof = scene.joints[0].dofs[0];
    const double unlimited = std::numeric_limits<double>::infinity();
    dof.lower = -unlimited, dof.upper = unlimited;
    const auto bonesMove = [&] {
        const bool swings = !skinParameters(scene, scene.skins[0]).swings.empty();
        CHECK(skinAskedMotion(scene, scene.skins[0], skinMuscles(scene, scene.skins[0]), 4).bones == swings);
        return swings;
    };
    CHECK(bonesMove());
    CHECK(swingEnds(dof)[1] == Approx(3.14159265));
    dof.kind = DofKind::Translation;
    CHECK_FALSE(bonesMove());
    dof.upper = 2;
    CHECK(bonesMove());
    CHECK(swingEnds(dof) == std::array{0.0, 2.0});
}
