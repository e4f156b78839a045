#include "bake/play/Player.h"

#include "bake/model/AddPair.h"
#include "bake/table/Table.h"
#include "tests/Joints.h"

#include <catch2/catch.hpp>
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
