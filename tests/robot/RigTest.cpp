// Rigged characters of mesh files: nodes, animations and weights as assimp has them, into a robot.
#include "bake/geometry/MeshAudit.h"
#include "bake/robot/ReadRig.h"
#include "tests/robot/Robots.h"

#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <numbers>

using namespace tss;

namespace {

constexpr double rigDegree = std::numbers::pi / 180;

Eigen::Affine3d rigShift(double x, double y, double z) {
    return Eigen::Affine3d(Eigen::Translation3d(x, y, z));
}

/// A square tube along z from 0 to 4, wound outwards.
TriangleMesh rigTube() {
    TriangleMesh mesh;
    for (int ring = 0; ring < 5; ++ring)
        for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}})
            mesh.vertices.emplace_back(x, y, ring);
    const auto quad = [&](int a, int b, int c, int d) {
        mesh.triangles.emplace_back(a, b, c);
        mesh.triangles.emplace_back(a, c, d);
    };
    quad(3, 2, 1, 0);
    for (int ring = 0; ring < 4; ++ring)
        for (int k = 0; k < 4; ++k)
            quad(4 * ring + k, 4 * ring + (k + 1) % 4, 4 * ring + 4 + (k + 1) % 4, 4 * ring + 4 + k);
    quad(16, 17, 18, 19);
    return mesh;
}

RigFile::Channel rigTurn(int node, const Vec3& place, double degrees) {
    RigFile::Channel channel;
    channel.node = node;
    channel.placeTimes = {0};
    channel.places = {place};
    channel.turnTimes = {0, 1};
    for (const double angle : {0.0, degrees * rigDegree})
        channel.turns.emplace_back(std::sin(angle / 2), 0, 0, std::cos(angle / 2));
    return channel;
}

/// Nodes: an armature of a hundredth, an upper and a lower bone, a mesh whose own node says nothing of it. It
/// is bound in units a hundred times as large.
RigFile rigArm() {
    RigFile rig;
    rig.nodes = {{"Scene", -1, Eigen::Affine3d::Identity()},
                 {"Armature", 0, Eigen::Affine3d(Eigen::Scaling(0.01))},
                 {"Upper", 1, rigShift(500, 0, 0)},
                 {"Lower", 2, rigShift(0, 0, 200)},
                 {"Skin", 0, rigShift(0, 77, 0)}};
    RigFile::Mesh mesh;
    mesh.node = 4;
    mesh.surface = rigTube();
    for (Vec3& v : mesh.surface.vertices) v *= 100;
    mesh.bones = {{2, Eigen::Affine3d::Identity()}, {3, rigShift(0, 0, -200)}};
    for (const Vec3& v : mesh.surface.vertices) mesh.weights.push_back({{v.z() < 200 ? 0 : 1, 1.0}});
    rig.meshes = {mesh};
    rig.animations = {{"Bend", {rigTurn(3, Vec3(0, 0, 200), 60)}}};
    return rig;
}

SceneModel rigScene(const RigFile& rig) {
    return sceneOf(rigRobot(rig, "arm.glb"), {}, noMeshes).scene;
}

Pose rigMoved(const SceneModel& scene, const std::string& body, double time) {
    const int index = findBody(scene, "/arm/" + body);
    REQUIRE(index >= 0);
    return posedBodies(scene, drivenValues(scene, time))[index] *
           scene.bodies[index].placement.inverse(Eigen::Isometry);
}

double rigApart(const Pose& a, const Pose& b) {
    return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

Pose rigBend(double degrees) {
    return Pose(Eigen::Translation3d(5, 0, 2) * Eigen::AngleAxisd(degrees * rigDegree, Vec3::UnitX()) *
                Eigen::Translation3d(-5, 0, -2));
}

} // namespace

TEST_CASE("bones of a mesh file are bodies in the size that its nodes give them, its meshes skins") {
    const SceneModel scene = rigScene(rigArm());
    REQUIRE(scene.skins.size() == 1);
    const auto box = bounds(scene.bodies[scene.skins[0].body].mesh);
    CHECK(box.min().isApprox(Vec3(4, -1, 0)));
    CHECK(box.max().isApprox(Vec3(6, 1, 4)));
    CHECK(scene.bodies.size() == 3); // not the armature, which is above the first bone
    for (const char* name : {"Upper", "Lower"}) CHECK(auditMesh(bodyCalled(scene, name).mesh).watertight);
    CHECK(jointCalled(scene, "Lower_joint").dofs.size() == 1);
    CHECK(scene.endTimeCode == 24);
    for (const auto& [time, degrees] : {std::pair(0.0, 0.0), {12.0, 30.0}, {24.0, 60.0}})
        CHECK(rigApart(rigMoved(scene, "Lower", time), rigBend(degrees)) < 1e-6);
    CHECK(scene.pairs.empty());
}

TEST_CASE("a mesh without bones goes with the node that it hangs below, and stands where none moves") {
    RigFile rig = rigArm();
    rig.nodes.push_back({"Hat", 3, rigShift(0, 0, 300)});
    RigFile::Mesh hat;
    hat.node = 5;
    hat.surface = rigTube();
    rig.nodes.push_back({"Floor", 0, rigShift(0, 0, -9)});
    RigFile::Mesh floor = hat;
    floor.node = 6;
    rig.meshes.push_back(hat);
    rig.meshes.push_back(floor);
    const SceneModel scene = rigScene(rig);
    REQUIRE(scene.skins.size() == 2);
    const SkinModel& skin = scene.skins[1];
    CHECK(skin.path == "/arm/Hat");
    REQUIRE(skin.weights.joints.size() == 1);
    CHECK(scene.bodies[skin.weights.joints[0]].path == "/arm/Lower");
    CHECK(bounds(scene.bodies[skin.body].mesh).min().isApprox(Vec3(4.99, -0.01, 5)));
    CHECK(bodyCalled(scene, "Floor").visible);
    CHECK(bounds(bodyCalled(scene, "Floor").mesh).min().z() == -9);
    CHECK(scene.pairs.size() == 1); // the lower arm moves against the floor
}

TEST_CASE("nodes that an animation moves are a machine, without any bone") {
    RigFile rig = rigArm();
    RigFile::Mesh& mesh = rig.meshes[0];
    mesh.bones.clear();
    mesh.weights.clear();
    mesh.node = 3;
    RigFile::Mesh above = mesh;
    above.node = 2;
    rig.meshes.push_back(above);
    const SceneModel scene = rigScene(rig);
    // The lower node alone is moved; what hangs on the upper one stands.
    REQUIRE(scene.skins.size() == 1);
    CHECK(scene.skins[0].path == "/arm/Lower2");
    CHECK(bodyCalled(scene, "Upper").visible);
    CHECK(rigApart(rigMoved(scene, "Lower", 24), rigBend(60)) < 1e-6);
    CHECK(scene.pairs.size() == 1);
}

TEST_CASE("the nodes that assimp cuts a node of FBX into are one bone") {
    RigFile rig = rigArm();
    // Lower hangs below its own rotation, which the animation moves.
    rig.nodes[3] = {"Lower_$AssimpFbx$_Translation", 2, rigShift(0, 0, 200)};
    rig.nodes[4] = {"Lower_$AssimpFbx$_Rotation", 3, Eigen::Affine3d::Identity()};
    rig.nodes.push_back({"Lower", 4, Eigen::Affine3d::Identity()});
    rig.nodes.push_back({"Skin", 0, Eigen::Affine3d::Identity()});
    rig.meshes[0].node = 6;
    rig.meshes[0].bones[1].first = 5;
    rig.animations = {{"Bend", {rigTurn(4, Vec3::Zero(), 60)}}};
    const SceneModel scene = rigScene(rig);
    CHECK(scene.bodies.size() == 3);
    CHECK(rigApart(rigMoved(scene, "Lower", 24), rigBend(60)) < 1e-6);
}

TEST_CASE("several animations widen the limits and are played one after the other") {
    RigFile rig = rigArm();
    rig.animations.push_back({"Back", {rigTurn(3, Vec3(0, 0, 200), -40)}});
    const RobotScene made = sceneOf(rigRobot(rig, "arm.glb"), {}, noMeshes);
    CHECK(hasNote(made.notes, "2 animations, played one after the other"));
    const Dof& turn = jointCalled(made.scene, "Lower_joint").dofs.at(0);
    CHECK(turn.upper - turn.lower == Approx(110 * rigDegree));
    CHECK(made.scene.endTimeCode == 72); // a second each, and one between them
    CHECK(rigApart(rigMoved(made.scene, "Lower", 72), rigBend(-40)) < 1e-6);
}

TEST_CASE("a character takes the animations of another file, by the names of its nodes and in its own unit") {
    RigFile rig = rigArm(), other;
    rig.notes.metersPerUnit = 1;
    rig.nodes[3].name = "mixamorig:Lower";
    rig.nodes[2].name = "Upper";
    other.nodes = {{"Root", -1, rigShift(0, 0, 0)},
                   {"Tail", 0, rigShift(0, 0, 0)},
                   {"Armature|lower", 0, rigShift(0, 0, 0)},
                   {"Upper", 0, rigShift(0, 0, 0)}};
    RigFile::Channel lifted = rigTurn(3, Vec3::Zero(), 0);
    lifted.placeTimes = {0, 1};
    lifted.places = {Vec3(50000, 0, 0), Vec3(50000, 0, 10000)}; // in hundredths of the rig's unit
    other.animations = {{"Walk", {rigTurn(1, Vec3::Zero(), 10), rigTurn(2, Vec3(0, 0, 20000), -30), lifted}}};
    other.notes.metersPerUnit = 0.01;
    takeAnimations(rig, other, "walk.fbx");
    const RobotScene made = sceneOf(rigRobot(rig, "arm.glb"), {}, noMeshes);
    CHECK(hasNote(made.notes, "left out: keys of 1 node that the character does not have: Tail"));
    CHECK(jointCalled(made.scene, "mixamorig_Lower_joint").dofs.size() == 1);
    const Pose lift(Eigen::Translation3d(0, 0, 1));
    CHECK(rigApart(rigMoved(made.scene, "Upper", 24), lift) < 1e-6);
    CHECK(rigApart(rigMoved(made.scene, "mixamorig_Lower", 24), lift * rigBend(-30)) < 1e-6);

    RigFile still = rigArm();
    CHECK(refusal([&] { takeAnimations(rig, RigFile{}, "none.fbx"); }) == "none.fbx: holds no animation");
    other.nodes[2].name = other.nodes[3].name = "Wing";
    CHECK(refusal([&] { takeAnimations(still, other, "bird.fbx"); }) ==
          "bird.fbx: moves none of the nodes of the character: Tail, Wing");
}

TEST_CASE("a mesh file in which nothing moves is refused") {
    RigFile rig = rigArm();
    rig.animations.clear();
    rig.meshes[0].bones.clear();
    rig.meshes[0].weights.clear();
    CHECK(refusal([&] { rigRobot(rig, "arm.glb"); }) ==
          "arm.glb: holds neither bones nor animations, so that nothing in it moves; expected a robot's "
          "file, a "
          "rigged character, or two meshes as --a and --b");
    rig.meshes.clear();
    CHECK(refusal([&] { rigRobot(rig, "arm.glb"); }).find("holds no triangle") != std::string::npos);
}

#ifdef OSGTSS_IMPORT

TEST_CASE("nodes, weights and an animation of a glTF come through assimp") {
    const std::string name = std::string(OSGTSS_BINARY_DIR) + "/rig.gltf";
    std::string bytes;
    const auto add = [&](std::initializer_list<float> values) {
        for (const float value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add({0, 0, 0, 1, 0, 0, 0, 1, 0});
    add({1, 0, 0, 0, 1, 0, 0, 0, 0.25, 0.75, 0, 0});
    add({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1});
    add({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -2, 0, 1});
    add({0, 0.5});
    add({0, 0, 0, 1, 0, 0, 1, 0}); // half a turn about z
    for (int k = 0; k < 3; ++k) bytes.append("\0\1\0\0", 4);
    std::ofstream(name + ".bin", std::ios::binary) << bytes;
    std::ofstream(name) << fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,2]}}],
"nodes":[{{"name":"a","translation":[1,0,0],"children":[1]}},{{"name":"b","translation":[-1,2,0]}},
{{"name":"m","mesh":0,"skin":0}}],"skins":[{{"joints":[0,1],"inverseBindMatrices":2}}],
"animations":[{{"name":"wave","channels":[{{"sampler":0,"target":{{"node":1,"path":"rotation"}}}}],
"samplers":[{{"input":4,"output":5}}]}}],
"meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"WEIGHTS_0":1,"JOINTS_0":3}}}}]}}],
"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},
{{"bufferView":1,"componentType":5126,"count":3,"type":"VEC4"}},
{{"bufferView":2,"componentType":5126,"count":2,"type":"MAT4"}},
{{"bufferView":5,"componentType":5121,"count":3,"type":"VEC4"}},
{{"bufferView":3,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[0.5]}},
{{"bufferView":4,"componentType":5126,"count":2,"type":"VEC4"}}],
"bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":48}},
{{"buffer":0,"byteOffset":84,"byteLength":128}},{{"buffer":0,"byteOffset":212,"byteLength":8}},
{{"buffer":0,"byteOffset":220,"byteLength":32}},{{"buffer":0,"byteOffset":252,"byteLength":12}}],
"buffers":[{{"byteLength":{},"uri":"rig.gltf.bin"}}]}})",
        bytes.size());
    const RigFile rig = readRigFile(name);
    std::filesystem::remove(name);
    std::filesystem::remove(name + ".bin");
    REQUIRE(rig.meshes.size() == 1);
    const RigFile::Mesh& mesh = rig.meshes[0];
    CHECK(mesh.surface.vertices == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    REQUIRE(mesh.bones.size() == 2);
    CHECK(rig.nodes[mesh.bones[1].first].name == "b");
    CHECK(mesh.bones[1].second.translation().isApprox(Vec3(0, -2, 0)));
    REQUIRE(mesh.weights.size() == 3);
    CHECK(mesh.weights[2] == std::vector<std::pair<int, double>>{{0, 0.25}, {1, 0.75}});
    REQUIRE(rig.animations.size() == 1);
    REQUIRE(rig.animations[0].channels.size() == 1);
    const RigFile::Channel& channel = rig.animations[0].channels[0];
    CHECK(rig.nodes[channel.node].name == "b");
    CHECK(channel.turnTimes == std::vector<double>{0, 0.5});
    CHECK(channel.turns.at(1).isApprox(Eigen::Vector4d(0, 0, 1, 0)));
    CHECK(channel.places.at(0).isApprox(Vec3(-1, 2, 0)));
    CHECK(rig.notes.metersPerUnit == 1);
    CHECK(rig.notes.leftOut.empty());
    const SceneModel scene = rigScene(rig);
    CHECK(bounds(scene.bodies[scene.skins.at(0).body].mesh).max().isApprox(Vec3(1, 1, 0)));
}

#endif
