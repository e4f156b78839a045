// Triangles without area that no other triangle has: a needle on a body, told by tables and proofs.
#include "bake/geometry/MeshQuery.h"
#include "bake/model/AddPair.h"
#include "bake/pipeline/Bake.h"
#include "bake/table/Query.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

Body body(const std::string& name, const TriangleMesh& mesh) {
    Body made;
    made.path = "/Scene/" + name;
    made.mesh = mesh;
    return made;
}

/// A ball with a needle without thickness that swings past a post.
SceneModel needleAndPost(double needle) {
    SceneModel scene;
    scene.metersPerUnit = 1;
    scene.defaultPrim = "Scene";
    TriangleMesh ball = ballMesh(Vec3::Zero(), 1, 2);
    const int first = static_cast<int>(ball.vertices.size());
    ball.vertices.emplace_back(0, 0, 0);
    ball.vertices.emplace_back(needle, 0, 0);
    ball.triangles.emplace_back(first, first + 1, first + 1);
    scene.bodies = {body("Post", boxMesh({-0.5, 3, -0.5}, {0.5, 4, 0.5})), body("Needle", ball)};
    Dof turn;
    turn.name = "turn";
    turn.axis = Vec3::UnitZ();
    turn.lower = 0;
    turn.upper = 3;
    Motion motion;
    motion.dofs = {turn};
    const int pair = addPair(scene, 0, 1, motion, "Turn");
    scene.pairs[pair].settings["tolerance"] = "0.02";
    return scene;
}

} // namespace

TEST_CASE("a needle without thickness is met like any other surface") {
    SceneModel scene = needleAndPost(3.5);
    bake(scene, {});
    const Pair& pair = scene.pairs[0];
    REQUIRE(pair.table);
    CHECK(pair.table->certified);
    CHECK(pair.table->boundMiss == 0);
    const Motion motion = pairMotion(scene, pair);
    const MeshQuery a(scene.bodies[0].mesh), b(scene.bodies[1].mesh);
    int touching = 0, early = 0;
    for (int i = 0; i <= 600; ++i) {
        const std::vector<double> q{3.0 * i / 600};
        const Pose at = pose(motion, q);
        const double distance = a.distanceTo(b, at);
        const bool hit = query(*pair.table, q).hit();
        if (distance == 0) {
            ++touching;
            CHECK(hit);
        } else if (hit) {
            ++early;
            CHECK(distance <= pair.table->boundEarly.value());
        }
    }
    CHECK(touching > 50);
    CHECK(early < 20);
}

TEST_CASE("a needle that ends before the post is proven to miss it, with a clearance that is its own") {
    SceneModel scene = needleAndPost(2.8);
    bake(scene, {});
    const Pair& pair = scene.pairs[0];
    REQUIRE(pair.proof);
    CHECK(pair.proof->clearance > 0);
    CHECK(pair.proof->clearance <= 0.2 * (1 + 1e-9)); // from the needle, not from the ball
}
