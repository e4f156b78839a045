#include "bake/BakePair.h"
#include "bake/search/TreePair.h"
#include "bake/table/Query.h"
#include "bake/verify/Verify.h"
#include "tests/geometry/TestMeshes.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

/// Two lumpy balls, one on a hinge that swings it into the other.
SceneModel lumpyPair(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    SceneModel scene;
    for (const char* name : {"A", "B"}) {
        Body body;
        body.path = std::string("/Scene/") + name;
        body.mesh = lumpyMesh(random, 2, 0.3);
        if (!scene.bodies.empty())
            body.mesh = transformed(body.mesh, Eigen::Affine3d(Eigen::Translation3d(2.6, 0, 0)));
        scene.bodies.push_back(body);
    }
    Pair pair;
    pair.bodyA = 0;
    pair.bodyB = 1;
    scene.pairs.push_back(pair);
    return scene;
}

Motion swing() {
    Dof dof;
    dof.origin = {1.3, 3, 0};
    dof.axis = Vec3::UnitZ();
    dof.lower = -0.5;
    dof.upper = 0.5;
    Motion motion;
    motion.dofs = {dof};
    return motion;
}

} // namespace

TEST_CASE("a table with a tolerance misses no contact: it reports by as much earlier") {
    int missedInAll = 0, refused = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        CAPTURE(seed);
        const int refusedBefore = refused;
        const Motion motion = swing();
        const SceneModel scene = lumpyPair(seed);
        BakeOptions options;
        options.tolerance = 0.05;
        options.epsilon = 0.05;
        options.atRest = AtRest::Collide;
        const PairSpheres spheres = fillPair(scene, scene.pairs[0], motion, options);
        PairReport report;
        const PairTable made = tabulatePair(spheres, motion, options, report);
        REQUIRE(made.table);
        const Table& table = *made.table;
        REQUIRE(table.epsilon > 0);
        CHECK(table.boundMiss == 0);
        CHECK(table.boundEarly <= 2 * 0.05 + table.epsilon + 1e-6);
        const SphereTree a(spheres.a.spheres), b(spheres.b.spheres);
        Table late = table;
        late.restGaps.clear();
        int touching = 0, missed = 0, lateMissed = 0;
        double farthest = 0;
        random_table::Random random(seed);
        for (int i = 0; i < 2000; ++i) {
            const std::vector<double> q = random_table::values(random, motion);
            const double gap = smallestGap(a, b, pose(motion, q), 10);
            const bool hit = query(table, q).hit();
            touching += gap <= 0;
            missed += gap <= 0 && !hit;
            lateMissed += gap <= 0 && !query(late, q).hit();
            if (hit) farthest = std::max(farthest, gap);
        }
        CHECK(touching > 100);
        CHECK(missed == 0);
        CHECK(farthest <= table.epsilon * (1 + 1e-9));
        VerifyOptions asked;
        asked.atRest = RestOverlaps::Collide;
        CHECK(verifyTable(spheres.a.spheres, spheres.b.spheres, table, motion, asked).reason.empty());
        refused += !verifyTable(spheres.a.spheres, spheres.b.spheres, late, motion, asked).reason.empty();
        if (lateMissed > 0) CHECK(refused > refusedBefore);
        missedInAll += lateMissed;
    }
    // The tolerance was used: without what the thresholds carry contact would have been missed.
    CHECK(missedInAll > 0);
}
