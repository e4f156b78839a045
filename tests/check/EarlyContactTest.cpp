#include "bake/check/EarlyContact.h"

#include "bake/model/AddPair.h"
#include "bake/pipeline/Bake.h"
#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>
#include <iomanip>
#include <numbers>
#include <sstream>

using namespace tss;
using namespace tss::test;

namespace {

/// A block that slides above a floor and against a wall at its end.
SceneModel slidingBlock(double tolerance, double above = 0.06) {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Scene";
    TriangleMesh floor = boxMesh({0, 0, 0}, {3, 1, 1});
    append(floor, boxMesh({2.8, 0, 1}, {3, 1, 2}));
    floor = quartered(floor, 2); // of a large triangle it is known at once how far it stays away
    for (const auto& [name, mesh] :
         {std::pair("Floor", floor), std::pair("Block", boxMesh({0, 0.2, 1 + above}, {0.5, 0.8, 1.5}))}) {
        Body body;
        body.path = std::string("/Scene/") + name;
        body.mesh = mesh;
        scene.bodies.push_back(body);
    }
    Dof slide;
    slide.name = "slide";
    slide.kind = DofKind::Translation;
    slide.axis = Vec3::UnitX();
    slide.upper = 2.5;
    Motion motion;
    motion.dofs = {slide};
    const int pair = addPair(scene, 0, 1, motion, "Slide");
    scene.pairs[pair].settings["tolerance"] =
        (std::ostringstream() << std::setprecision(17) << tolerance).str();
    return scene;
}

EarlyContact baked(SceneModel scene) {
    CHECK_FALSE(measureEarlyContact(scene, scene.pairs[0]));
    bake(scene, {});
    const auto measured = measureEarlyContact(scene, scene.pairs[0]);
    REQUIRE(measured);
    return *measured;
}

EarlyContact baked(double tolerance, double above = 0.06) {
    return baked(slidingBlock(tolerance, above));
}

/// The block, thinner by `inset` on both sides, between two walls that are 0.48 apart and that it may pass
/// through.
SceneModel wedgedBlock(double inset) {
    SceneModel scene = slidingBlock(0.005);
    scene.bodies[1].mesh = boxMesh({inset, 0.2, 1.06}, {0.5 - inset, 0.8, 1.5});
    TriangleMesh& walls = scene.bodies[0].mesh;
    walls = boxMesh({-0.1, 0, 0}, {0.01, 1, 2});
    append(walls, boxMesh({0.49, 0, 0}, {0.6, 1, 2}));
    Dof& slide = scene.joints[0].dofs[0];
    slide.lower = -2;
    slide.upper = 2;
    return scene;
}

} // namespace

TEST_CASE("a tolerance that a joint's clearance cannot bear is told, and one that it can is proposed") {
    const EarlyContact coarse = baked(0.1);
    CHECK(coarse.coarse());
    CHECK(coarse.atRest == Approx(0.06).epsilon(0.15));
    CHECK(coarse.share > 0.9);
    CHECK(coarse.freePoses > 50);
    CHECK(coarse.tolerance < 0.03);
    CHECK(coarse.tolerance > 0.006);
    CHECK(coarse.shareThen < 0.1);
    const EarlyContact fine = baked(coarse.tolerance);
    CHECK_FALSE(fine.coarse());
    CHECK(fine.share <= coarse.shareThen);
    CHECK(fine.tolerance == 0);
}

TEST_CASE("bodies that overlap wherever the joint goes are stuck where no exception is made of that") {
    SceneModel sunk = slidingBlock(0.02, -0.1);
    sunk.pairs[0].settings["at-rest"] = "collide";
    CHECK(baked(sunk).stuck());
    CHECK_FALSE(baked(0.02, -0.1).stuck());
    CHECK_FALSE(baked(0.02).stuck());
}

TEST_CASE("bodies that overlap at rest and go deeper with every small step are told to be held") {
    const EarlyContact wedged = baked(wedgedBlock(0));
    CHECK(wedged.held);
    CHECK_FALSE(wedged.stuck());
    CHECK_FALSE(baked(wedgedBlock(0.1)).held);
    CHECK_FALSE(baked(0.02).held);
}

TEST_CASE("a clearance of less than a thousandth of the bodies is told as it is, and not called touching") {
    SceneModel scene = slidingBlock(0.02, 5e-4);
    scene.pairs[0].settings["at-rest"] = "collide";
    scene.pairs[0].settings["epsilon"] = "0.001"; // spheres need not be apart at rest
    const EarlyContact close = baked(scene);
    CHECK(close.atRest == Approx(5e-4));
    CHECK(close.close);
    CHECK_FALSE(close.restReported);
}

TEST_CASE("joints that turn all the way round are not looked at where their limits are one pose") {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Scene";
    for (const auto& [name, mesh] : {std::pair("Wall", boxMesh({-1, -1, 1.02}, {1, 1, 1.2})),
                                     std::pair("Rod", boxMesh({-0.05, -0.05, -1}, {0.05, 0.05, 1}))}) {
        Body body;
        body.path = std::string("/Scene/") + name;
        body.mesh = mesh;
        scene.bodies.push_back(body);
    }
    constexpr double pi = std::numbers::pi;
    Motion motion; // about its middle: it is near the wall only where an end points there
    motion.dofs = {joints::turn({0, 0, 0}, {1, 0, 0}, -pi, pi), joints::turn({0, 0, 0}, {0, 1, 0}, -pi, pi),
                   joints::turn({0, 0, 0}, {0, 0, 1}, -pi, pi)};
    addPair(scene, 0, 1, motion, "Turns");
    scene.pairs[0].settings = {{"tolerance", "0.06"}, {"budget", "0.01"}};
    const EarlyContact early = baked(scene);
    CHECK(early.freePoses == 100);
    CHECK(early.share > 0);
    CHECK(early.share < 0.25);
}
