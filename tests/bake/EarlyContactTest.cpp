#include "bake/EarlyContact.h"

#include "bake/Bake.h"
#include "bake/scene/AddPair.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

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
    scene.pairs[pair].settings["tolerance"] = fmt::format("{}", tolerance);
    return scene;
}

EarlyContact baked(double tolerance, double above = 0.06) {
    SceneModel scene = slidingBlock(tolerance, above);
    CHECK_FALSE(measureEarlyContact(scene, scene.pairs[0]));
    bake(scene, {});
    const auto measured = measureEarlyContact(scene, scene.pairs[0]);
    REQUIRE(measured);
    return *measured;
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

TEST_CASE("bodies that overlap wherever the joint goes are told to be stuck") {
    CHECK(baked(0.02, -0.1).stuck());
    CHECK_FALSE(baked(0.02).stuck());
}
