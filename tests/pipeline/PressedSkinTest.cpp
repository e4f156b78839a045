// Skin between bones that come together, which press it from both sides.
#include "bake/model/AddPair.h"
#include "bake/model/Kinematics.h"
#include "bake/pipeline/Bake.h"
#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinResponse.h"
#include "tests/Joints.h"
#include "tests/LevelSet.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace tss;
using namespace tss::test;

namespace {

constexpr double degree = M_PI / 180;

/// A trunk and two legs under one skin; each leg swings about the crotch in the plane of both.
/// halfAngle: between each leg and straight down; radius: of the bones, of the flesh about them.
SceneModel forkScene(double halfAngle, double radius) {
    SceneModel scene;
    const Vec3 crotch = Vec3::Zero();
    const std::array<Vec3, 3> ends{Vec3(0, 0, 1.2), 1.2 * Vec3(std::sin(halfAngle), 0, -std::cos(halfAngle)),
                                   1.2 * Vec3(-std::sin(halfAngle), 0, -std::cos(halfAngle))};
    const std::array<double, 3> flesh{0.25, 0.17, 0.17};
    const auto add = [&](const std::string& name, const std::function<double(const Vec3&)>& f, double step) {
        Body body;
        body.path = "/Fork/" + name;
        body.mesh = levelSet(f, Vec3(-1.5, -0.5, -1.6), Vec3(1.5, 0.5, 1.7), step);
        scene.bodies.push_back(std::move(body));
    };
    for (int k = 0; k < 3; ++k)
        add(
            "Bone" + std::to_string(k),
            [&](const Vec3& x) {
                const Vec3 from = 0.1 * ends[k], to = 0.9 * ends[k];
                return fromSegment(x, from, to) - radius * flesh[k];
            },
            0.05);
    add(
        "Skin",
        [&](const Vec3& x) {
            double least = 10;
            for (int k = 0; k < 3; ++k) least = std::min(least, fromSegment(x, crotch, ends[k]) - flesh[k]);
            return least;
        },
        0.055);
    for (const int leg : {1, 2}) {
        Motion motion;
        motion.dofs = {joints::turn(crotch, Vec3::UnitY(), -60 * degree, 60 * degree)};
        addJoints(scene, 0, leg, motion, "Hip" + std::to_string(leg));
    }
    SkinModel skin;
    skin.path = "/Fork/Skin";
    skin.body = 3;
    skin.bones = {0, 1, 2};
    scene.skins = {skin};
    return scene;
}

} // namespace

TEST_CASE("skin that bones press from two sides is thrown nowhere") {
    for (const auto& [halfAngle, radius] :
         {std::pair(12 * degree, 0.5), {15 * degree, 0.3}, {20 * degree, 0.6}}) {
        SceneModel scene = forkScene(halfAngle, radius);
        bake(scene);
        SkinResponse response(skinRig(scene, scene.skins[0]));
        const std::vector<Vec3>& rest = scene.bodies[3].mesh.vertices;
        double farthest = 0;
        for (int a = -60; a <= 60; a += 4)
            for (int b = -60; b <= 60; b += 12) {
                const std::vector<double> q{a * degree, b * degree};
                const std::vector<Pose> placed = posedBodies(scene, q);
                response.update(std::vector<double>(3, 0), skinPoses(scene, scene.skins[0], placed));
                for (std::size_t k = 0; k < response.vertices().size(); ++k)
                    farthest =
                        std::max(farthest, (response.positions()[k] - rest[response.vertices()[k]]).norm());
            }
        // The ends of the legs go by 1.37, whoever carries them.
        CHECK(farthest > 1.3);
        CHECK(farthest < 1.8);
    }
}
