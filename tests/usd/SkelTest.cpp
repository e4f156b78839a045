// UsdSkel: skeletons, their animations, and the meshes that follow them.
#include "tests/usd/Skel.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/model/Kinematics.h"

#include <algorithm>
#include <numbers>

using namespace tss;

namespace {

constexpr double skelDegree = std::numbers::pi / 180;

const Joint& jointOf(const SceneModel& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.joints, "/Arm/" + name, &Joint::path);
    REQUIRE(found != scene.joints.end());
    return *found;
}

/// What a body of the scene has done since rest.
Pose movedAt(const SceneModel& scene, const std::string& body, double time) {
    const int index = findBody(scene, "/Arm/" + body);
    REQUIRE(index >= 0);
    return posedBodies(scene, drivenValues(scene, time))[index] *
           scene.bodies[index].placement.inverse(Eigen::Isometry);
}

Pose elbowTurn(double degrees) {
    return Pose(Eigen::Translation3d(0, 0, 2) * Eigen::AngleAxisd(degrees * skelDegree, Vec3::UnitX()) *
                Eigen::Translation3d(0, 0, -2));
}

double apart(const Pose& a, const Pose& b) {
    return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

} // namespace

TEST_CASE("joints of a skeleton are bodies that its animation moves, whatever its order of joints") {
    const RobotScene made = robotScene(armStage());
    const SceneModel& scene = made.scene;
    const Joint& elbow = jointOf(scene, "Elbow_joint");
    REQUIRE(elbow.dofs.size() == 1);
    CHECK(elbow.dofs[0].upper - elbow.dofs[0].lower == Approx(110 * skelDegree).epsilon(1e-5));
    CHECK(jointOf(scene, "Shoulder_joint").dofs.empty());
    CHECK(jointOf(scene, "Hand_joint").dofs.empty());
    CHECK(scene.endTimeCode == 24);
    for (const auto& [time, degrees] : {std::pair(0.0, 0.0), {12.0, 60.0}, {6.0, 30.0}, {24.0, -40.0}}) {
        INFO(time);
        CHECK(apart(movedAt(scene, "Elbow", time), elbowTurn(degrees)) < 1e-5);
        CHECK(apart(movedAt(scene, "Hand", time), elbowTurn(degrees)) < 1e-5);
        CHECK(apart(movedAt(scene, "Shoulder", time), Pose::Identity()) < 1e-12);
    }
}

TEST_CASE("bodies are the mesh cut by its weights, undrawn; the mesh is a skin that follows them") {
    const SceneModel scene = robotScene(armStage()).scene;
    for (const char* name : {"/Arm/Shoulder", "/Arm/Elbow"}) {
        const Body& body = scene.bodies[findBody(scene, name)];
        CHECK(auditMesh(body.mesh).watertight);
        CHECK_FALSE(body.visible);
    }
    CHECK(scene.bodies[findBody(scene, "/Arm/Hand")].mesh.empty()); // it stands, and is of the elbow's
    CHECK(bounds(scene.bodies[findBody(scene, "/Arm/Elbow")].mesh).max().z() == Approx(4)); // in its frame
    CHECK(scene.pairs.empty()); // they follow one another
    REQUIRE(scene.skins.size() == 1);
    const SkinModel& skin = scene.skins[0];
    CHECK(skin.path == "/Arm/Skin");
    CHECK(skin.bones.empty());
    CHECK(scene.bodies[skin.body].mesh.vertices.size() == 28);
    CHECK(scene.bodies[skin.body].visible);
    const auto share = [&](std::size_t vertex, const char* body) {
        double sum = 0;
        for (std::size_t k = vertex * skin.weights.influences; k < (vertex + 1) * skin.weights.influences;
             ++k)
            if (scene.bodies[skin.weights.joints.at(skin.weights.indices[k])].path == body)
                sum += skin.weights.weights[k];
        return sum;
    };
    CHECK(share(0, "/Arm/Shoulder") == 1);
    CHECK(share(8, "/Arm/Shoulder") == 0.5);
    CHECK(share(8, "/Arm/Elbow") == 0.5);
    CHECK(share(27, "/Arm/Elbow") == 1);
}

TEST_CASE("a skeleton stands where its prim is, in its size, and its mesh where it was bound") {
    const std::string place = R"usda(  double3 xformOp:translate = (10, 0, 0)
  float3 xformOp:scale = (2, 2, 2)
  uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"])usda";
    const std::string bound = "  matrix4d primvars:skel:geomBindTransform = "
                              "((1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0,1,1))";
    // The mesh's own transform says nothing once it follows a skeleton.
    const std::string own = "\n  double3 xformOp:translate = (0, 77, 0)\n"
                            "  uniform token[] xformOpOrder = [\"xformOp:translate\"]";
    const SceneModel scene = robotScene(armStage(place, bound + own)).scene;
    const auto box = bounds(scene.bodies[scene.skins.at(0).body].mesh);
    CHECK(box.min().isApprox(Vec3(9, -1, 2)));
    CHECK(box.max().isApprox(Vec3(11, 1, 14)));
    const Pose moved = movedAt(scene, "Elbow", 12);
    const Pose expected =
        Pose(Eigen::Translation3d(10, 0, 4) * Eigen::AngleAxisd(60 * skelDegree, Vec3::UnitX()) *
             Eigen::Translation3d(-10, 0, -4));
    CHECK(apart(moved, expected) < 1e-5);
}

TEST_CASE("a joint that stands otherwise than it is bound is one from the one pose to the other") {
    std::string stage = armStage();
    const std::string rest = "restTransforms = [((1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0,0,1))";
    stage.replace(stage.find(rest), rest.size(),
                  "restTransforms = [((0,1,0,0), (-1,0,0,0), (0,0,1,0), (0,0,0,1))");
    // The character is carried so that its first joint is bound as it rests.
    const SceneModel turned = robotScene(stage).scene;
    CHECK(jointOf(turned, "Shoulder_joint").dofs.empty());
    CHECK(apart(turned.bodies[findBody(turned, "/Arm/Shoulder")].placement,
                Pose(Eigen::AngleAxisd(90 * skelDegree, Vec3::UnitZ()))) < 1e-12);
    stage = armStage("", "", " rel skel:animationSource = []\n");
    stage.erase(stage.find(" rel skel:animationSource = </Arm/Wave>"), 39);
    const std::string elbow = "(0,0,0,1)), ((1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0,2,1))";
    stage.replace(stage.rfind(elbow), elbow.size(),
                  "(0,0,0,1)), ((0,1,0,0), (-1,0,0,0), (0,0,1,0), (0,0,2,1))");
    const RobotScene made = robotScene(stage);
    CHECK(hasNote(made.notes, "skeletons without an animation: their joints have no range: /Arm/Skel"));
    const Joint& joint = jointOf(made.scene, "Elbow_joint");
    REQUIRE(joint.dofs.size() == 1);
    CHECK(joint.dofs[0].upper - joint.dofs[0].lower == Approx(99 * skelDegree));
    CHECK(apart(movedAt(made.scene, "Elbow", 0), Pose(Eigen::AngleAxisd(90 * skelDegree, Vec3::UnitZ()))) <
          1e-9);
}

TEST_CASE("influences that are constant hold the whole mesh, also one that is no Mesh") {
    const std::string hat = R"usda( def Cube "Hat" {
  double size = 1
  matrix4d primvars:skel:geomBindTransform = ((1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0,9,1))
  int[] primvars:skel:jointIndices = [2] ( elementSize = 1 interpolation = "constant" )
  float[] primvars:skel:jointWeights = [1]
 })usda";
    const SceneModel scene = robotScene(armStage("", "", hat)).scene;
    REQUIRE(scene.skins.size() == 2);
    const SkinModel& skin = scene.skins[0];
    CHECK(skin.path == "/Arm/Hat");
    REQUIRE(skin.weights.joints.size() == 1);
    CHECK(scene.bodies[skin.weights.joints[0]].path == "/Arm/Elbow");
    CHECK(bounds(scene.bodies[skin.body].mesh).min().isApprox(Vec3(-0.5, -0.5, 8.5)));
}

TEST_CASE("limbs that do not follow one another are a pair") {
    // Two children of the shoulder: the hand hangs on it too.
    std::string stage = armStage();
    for (auto at = stage.find("Shoulder/Elbow/Hand"); at != stage.npos;
         at = stage.find("Shoulder/Elbow/Hand"))
        stage.replace(at, 19, "Shoulder/Hand");
    stage.replace(stage.find("12: [(1, 0, 0, 0)"), 17, "12: [(0.9, 0.43589, 0, 0)");
    const SceneModel scene = robotScene(stage).scene;
    std::vector<std::string> pairs;
    for (const Pair& pair : scene.pairs)
        pairs.push_back(scene.bodies[pair.bodyA].path + scene.bodies[pair.bodyB].path);
    std::ranges::sort(pairs);
    // The elbow was cut off the shoulder; the hand off the elbow, which it does not follow.
    CHECK(pairs == std::vector<std::string>{"/Arm/Elbow/Arm/Hand", "/Arm/Shoulder/Arm/Hand"});
}

TEST_CASE("a character beside rigid bodies leaves their pairs as they were") {
    const SceneModel alone = robotScene(twoBoxes(hinge)).scene;
    std::string arm = armStage();
    arm.erase(0, arm.find("def SkelRoot"));
    const RobotScene made = robotScene(twoBoxes(hinge) + arm);
    REQUIRE(alone.pairs.size() == 1);
    REQUIRE(made.scene.pairs.size() == 1);
    CHECK(made.scene.pairs[0].path == alone.pairs[0].path);
    CHECK(made.scene.skins.size() == 1);
    CHECK(made.scene.skins[0].path == "/R/Skin");
}

TEST_CASE("what of a character cannot be read is left out by name, with what is wrong") {
    const auto note = [](const std::string& was, const std::string& is, const std::string& words) {
        std::string stage = armStage();
        const auto at = stage.find(was);
        REQUIRE(at != stage.npos);
        stage.replace(at, was.size(), is);
        INFO(words);
        const RobotScene made = robotScene(stage);
        CHECK(hasNote(made.notes, words));
        CHECK(std::ranges::any_of(made.scene.bodies,
                                  [](const Body& body) { return body.path == "/Arm/Skin"; }));
    };
    note("uniform matrix4d[] bindTransforms", "custom matrix4d[] otherTransforms",
         "skeletons that cannot be read, so that their meshes stand still: /Arm/Skel (expected "
         "bindTransforms");
    note("bindTransforms = [((1,0,0,0), (0,1,0,0), (0,0,1,0), (0,0,0,1)), ", "bindTransforms = [",
         "/Arm/Skel (bindTransforms: expected 3 matrices, one a joint, found 2)");
    note("bindTransforms = [((1,0,0,0)", "bindTransforms = [((0,0,0,0)", "that can be inverted");
    note("[\"Shoulder\", \"Shoulder/Elbow\"", "[\"Shoulder/Elbow\", \"Shoulder\"",
         "/Arm/Skel (joints: expected each joint behind its parent, found \"Shoulder/Elbow\" before");
    note("translations = [(0, 0, 2), ", "translations = [",
         "animations that cannot be read: /Arm/Wave (translations: expected 2 values, one a joint, found 1)");
    note("\"Shoulder/Elbow\"]", "\"Other\"]",
         "joints of animations that their skeleton does not have: /Arm/Wave (Other)");
    note("rel skel:skeleton = </Arm/Skel>", "rel skel:skeleton = </Arm/Wave>",
         "/Arm.skel:skeleton (expected the path of a Skeleton, found \"/Arm/Wave\")");
    note("rel skel:skeleton = </Arm/Skel>", "", "weights of meshes that are bound to no skeleton: /Arm/Skin");
    note("skel:joints = [\"Shoulder/Elbow\"", "skel:joints = [\"Knee\"",
         "/Arm/Skin (skel:joints: expected joints of the skeleton, found \"Knee\")");
    note("jointIndices = [1, ", "jointIndices = [3, ",
         "/Arm/Skin (primvars:skel:jointIndices: expected indices from 0 to 2, found 3)");
    note("jointIndices = [1, ", "jointIndices = [",
         "/Arm/Skin (primvars:skel:jointIndices: expected 56 numbers, 2 (the elementSize) a vertex of 28, "
         "found 55)");
    note("elementSize = 2 )\n  float", "elementSize = 1 )\n  float",
         "primvars:skel:jointWeights: expected the elementSize and interpolation of");
}

TEST_CASE("scales that an animation changes are left out by name") {
    std::string stage = armStage();
    stage.replace(stage.find("scales = [(1, 1, 1), (1, 1, 1)]"), 31,
                  "scales.timeSamples = { 0: [(1, 1, 1), (1, 1, 1)], 24: [(1, 1, 1), (1, 1.5, 1)] }");
    CHECK(hasNote(robotScene(stage).notes, "animated scales; these bones keep the size that they are bound "
                                           "in: Elbow"));
}
