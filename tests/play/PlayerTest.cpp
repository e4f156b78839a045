#include "bake/play/Player.h"

#include "bake/model/AddPair.h"
#include "bake/motion/MuscleDeformer.h"
#include "bake/table/Table.h"
#include "tests/Joints.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

using namespace tss;

TEST_CASE("a joint that turns all the way round is played on where its limits meet, and stops at contact") {
    constexpr double degree = std::numbers::pi / 180;
    SceneModel scene;
    scene.bodies.resize(2);
    scene.bodies[0].path = "/Scene/post";
    scene.bodies[1].path = "/Scene/arm";
    Motion motion;
    motion.dofs = {joints::turn(Vec3::Zero(), Vec3::UnitZ(), -180 * degree, 180 * degree)};
    addPair(scene, 0, 1, motion, "Turn");
    // A post in the way at 90 degrees.
    scene.pairs[0].table = std::make_shared<const Table>(makeTable(
        {{Vec3(0, 1, 0), 0.2}}, {{Vec3(1, 0, 0), 0.1}}, {{0, 0}}, {}, pairMotion(scene, scene.pairs[0])));
    std::vector<std::string> warnings;
    Player player(scene, warnings);
    CHECK(player.step({-170 * degree}, 0).values[0] == Approx(-170 * degree));
    const double beyond = std::remainder(player.step({-200 * degree}, 0).values[0] - 160 * degree,
                                         360 * degree); // 30 degrees on, and not at the limit
    CHECK(std::abs(beyond) < 1e-9);
    const Player::Step stopped = player.step({-268 * degree}, 0); // in the post
    CHECK(stopped.status != JointStatus::Free);
    const double angle = std::remainder(stopped.values[0], 360 * degree) / degree;
    CHECK(angle > 95);
    CHECK(angle < 125);
}

TEST_CASE("a step that asks for no number stays, and the next one still stops at contact") {
    SceneModel scene;
    scene.bodies.resize(2);
    scene.bodies[0].path = "/Scene/wall";
    scene.bodies[1].path = "/Scene/slide";
    Motion motion;
    motion.dofs = {joints::slide(Vec3::UnitX(), 0, 5), joints::slide(Vec3::UnitY(), -1, 1)};
    motion.planes = {{{1, 1}, 5}};
    addPair(scene, 0, 1, motion, "Slide");
    scene.pairs[0].table = std::make_shared<const Table>(makeTable(
        {{Vec3(3, 0, 0), 0.5}}, {{Vec3(0, 0, 0), 0.5}}, {{0, 0}}, {}, pairMotion(scene, scene.pairs[0])));
    std::vector<std::string> warnings;
    Player player(scene, warnings);
    player.step({1, 0.25}, 0);
    const Player::Step none = player.step({std::nan(""), 0.5}, 1);
    CHECK(none.values == std::vector<double>{1, 0.5});
    CHECK(none.gap < 2);
    const Player::Step next = player.step({4, HUGE_VAL}, 2);
    CHECK(next.values[0] < 3);
    CHECK(next.gap > 0);
}

TEST_CASE("a muscle under no skin plays: it contracts, and goes with its bone") {
    SceneModel scene;
    for (const double x : {-1.0, 1.0}) {
        Body bone;
        bone.path = x < 0 ? "/Limb/Upper" : "/Limb/Lower";
        bone.mesh = boxMesh({x - 0.8, -0.2, -0.2}, {x + 0.8, 0.2, 0.2});
        scene.bodies.push_back(bone);
    }
    Motion motion;
    motion.dofs = {joints::turn(Vec3::Zero(), Vec3::UnitY(), -1, 1)};
    addJoints(scene, 0, 1, motion, "Elbow");
    Body belly;
    belly.path = "/Limb/Belly";
    belly.mesh = ballMesh({1, 0, 0.6}, 0.4, 3);
    scene.bodies.push_back(belly);
    MuscleModel muscle;
    muscle.path = "/Limb/Muscle";
    muscle.body = 2;
    muscle.bone = 1;
    muscle.muscle.fibre = {{0.6, 0, 0.6}, {1.4, 0, 0.6}};
    muscle.muscle.surface = belly.mesh;
    muscle.activation = TimeSamples{{0}, {1}};
    scene.muscles = {muscle};
    std::vector<std::string> warnings;
    Player player(scene, warnings);
    player.step({0.7}, 0);
    const std::vector<Vec3> now = player.worldMeshes()[2].vertices;
    const std::vector<Vec3> active = MuscleDeformer(muscle.muscle).vertices(1.0);
    const Pose turned(Eigen::AngleAxisd(0.7, Vec3::UnitY()));
    for (std::size_t v = 0; v < now.size(); ++v) CHECK((now[v] - turned * active[v]).norm() < 1e-9);
    CHECK((active[0] - belly.mesh.vertices[0]).norm() > 0.01);
    CHECK(warnings.empty());
    std::vector<Tri>& half = scene.muscles[0].muscle.surface.triangles;
    half.resize(half.size() / 2);
    Player without(scene, warnings);
    CHECK(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
        return warning.find("/Limb/Muscle does not play") != std::string::npos;
    }));
}

TEST_CASE("the muscles on a bone are shown where the bone has taken them") {
    SceneModel scene;
    const auto add = [&](const std::string& name, TriangleMesh mesh) {
        Body body;
        body.path = "/Limb/" + name;
        body.mesh = std::move(mesh);
        scene.bodies.push_back(std::move(body));
    };
    add("Upper", boxMesh({-2, -0.2, -0.2}, {-0.2, 0.2, 0.2}));
    add("Lower", boxMesh({0.2, -0.2, -0.2}, {2, 0.2, 0.2}));
    add("Belly", boxMesh({0.5, -0.1, 0.3}, {1.5, 0.1, 0.5}));
    add("Skin", ballMesh(Vec3::Zero(), 3, 3));
    Motion motion;
    motion.dofs = {joints::turn(Vec3::Zero(), Vec3::UnitY(), -1, 1)};
    addJoints(scene, 0, 1, motion, "Elbow");
    MuscleModel muscle;
    muscle.path = "/Limb/Muscle";
    muscle.body = 2;
    muscle.bone = 1;
    muscle.muscle.fibre = {{0.5, 0, 0.4}, {1.5, 0, 0.4}};
    muscle.muscle.surface = scene.bodies[2].mesh;
    SkinModel skin;
    skin.path = "/Limb/Skin";
    skin.body = 3;
    skin.bones = {0, 1};
    skin.muscles = {0};
    for (const double range : {1.0, 0.0}) { // one that contracts, though it is at rest, and a rigid one
        INFO(range);
        muscle.muscle.activationUpper = range;
        scene.muscles = {muscle};
        scene.skins = {skin};
        std::vector<std::string> warnings;
        Player player(scene, warnings);
        player.step({0.7}, 0);
        const std::vector<TriangleMesh> meshes = player.worldMeshes();
        const Pose turned(Eigen::AngleAxisd(0.7, Vec3::UnitY()));
        for (std::size_t v = 0; v < 8; ++v)
            CHECK((meshes[2].vertices[v] - turned * scene.bodies[2].mesh.vertices[v]).norm() < 1e-6);
    }
}
