#include "bake/verify/MeshProof.h"
#include "bake/verify/MeshVerify.h"
#include "bake/verify/Nesting.h"
#include "bake/verify/TestTree.h"
#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;
using namespace tss::test;

namespace {

/// Balls on the faces of a box, each over one of n by n parts of a face.
std::vector<Sphere> ballsOver(const Vec3& lower, const Vec3& upper, int n) {
    std::vector<Sphere> balls;
    const Vec3 size = upper - lower;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {0.0, 1.0})
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j) {
                    Vec3 share;
                    share[axis] = side;
                    share[(axis + 1) % 3] = (i + 0.5) / n;
                    share[(axis + 2) % 3] = (j + 0.5) / n;
                    balls.push_back({lower + size.cwiseProduct(share), 0.75 * size.maxCoeff() / n});
                }
    return balls;
}

/// A box that turns in three ways beside another, and a table of all pairs of balls over the two.
struct AllPairs {
    TriangleMesh a = boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}),
                 b = boxMesh({0.7, -0.2, -0.2}, {1.1, 0.2, 0.2});
    std::vector<Sphere> ballsA = ballsOver({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 5),
                        ballsB = ballsOver({0.7, -0.2, -0.2}, {1.1, 0.2, 0.2}, 4);
    Motion motion;

    AllPairs() {
        motion.dofs = {joints::turn(Vec3(0, 0, 0), Vec3::UnitZ(), -2, 2),
                       joints::turn(Vec3(0.8, 0, 0), Vec3::UnitY(), -1, 1),
                       joints::slide(Vec3::UnitX(), -0.4, 0.2)};
    }
    Table table() const {
        std::vector<SpherePair> pairs;
        for (std::uint32_t i = 0; i < ballsA.size(); ++i)
            for (std::uint32_t j = 0; j < ballsB.size(); ++j) pairs.push_back({i, j});
        Table table = makeTable(ballsA, ballsB, pairs, {}, motion);
        table.boundMiss = 0;
        table.certified = true;
        return table;
    }
};

} // namespace

TEST_CASE("a table that asks all pairs of spheres over two surfaces is proven whatever the motion") {
    AllPairs pair;
    const MeshVerdict verdict = verifyOnMeshes(pair.a, pair.b, pair.table(), pair.motion);
    INFO(verdict.reason);
    CHECK(verdict.miss);
    CHECK(verdict.cells == 0); // of the motion: thousands where boxes of it are looked at
    // A part that no sphere is over is looked at all over the limits, and found.
    for (int row = 3; row >= 1; --row) { // the middle of the face towards B
        const auto first = pair.ballsA.begin() + 25 + 5 * row + 1;
        pair.ballsA.erase(first, first + 3);
    }
    const MeshVerdict bare = verifyOnMeshes(pair.a, pair.b, pair.table(), pair.motion);
    CHECK_FALSE(bare.holds());
    CHECK(bare.pose.size() == 3);
}

TEST_CASE("of a table that asks nearly all pairs the boxes are left only what no test holds") {
    const AllPairs pair;
    Table table = pair.table();
    const verify::SurfaceTree a(pair.a, {}), b(pair.b, {});
    verify::MeshClaim claim;
    claim.tests = verify::meshTests(table);
    REQUIRE(verify::pairsNotHeld(a, b, claim));
    CHECK(verify::pairsNotHeld(a, b, claim)->empty());
    // Balls 0 of both are over corners that no other is over.
    std::erase_if(claim.tests, [](const verify::MeshTest& t) { return t.sphereA == 0 && t.sphereB == 0; });
    const auto left = verify::pairsNotHeld(a, b, claim);
    REQUIRE(left);
    REQUIRE_FALSE(left->empty());
    const auto reaches = [](const verify::Slab& slab, const Sphere& ball) {
        return (slab.centre - ball.centre).norm() <= slab.reach + ball.radius;
    };
    verify::PieceShapes ofA(a), ofB(b);
    for (const verify::PiecePair& pieces : *left) {
        CHECK(reaches(ofA.of(pieces.a).slab, pair.ballsA[0]));
        CHECK(reaches(ofB.of(pieces.b).slab, pair.ballsB[0]));
    }
    // Half of them are too few to be looked at pair by pair, and a threshold below 0 holds nothing.
    std::erase_if(claim.tests, [](const verify::MeshTest& t) { return t.sphereA % 2 == 0; });
    std::erase_if(claim.tests, [](const verify::MeshTest& t) { return t.sphereA % 3 == t.sphereB % 3; });
    CHECK_FALSE(verify::pairsNotHeld(a, b, claim));
}

TEST_CASE(
    "the deepest tests in a box are found without a look at all of them, and none only where none fires") {
    const AllPairs pair;
    const std::vector<verify::MeshTest> tests = verify::meshTests(pair.table());
    const verify::TestTree tree(tests);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(0, 1);
    std::uint64_t work = 0;
    int none = 0;
    for (int n = 0; n < 200; ++n) {
        verify::Box box;
        for (const Dof& dof : pair.motion.dofs) {
            const double at = dof.lower + share(random) * (dof.upper - dof.lower);
            box.lower.push_back(at);
            box.upper.push_back(at + 0.02);
        }
        const verify::PoseBox moved(pair.motion, box, 10);
        const auto gapOf = [&](const verify::MeshTest& t, const Pose& at) {
            return (at * t.centreB - t.centreA).norm() - t.contactDistance;
        };
        double least = 1e9;
        bool fires = false;
        for (const verify::MeshTest& t : tests) {
            least = std::min(least, gapOf(t, moved.pose()));
            fires |= gapOf(t, moved.pose()) <= moved.carry(t.centreB, false).move;
        }
        CHECK(tree.leastGap(moved.pose(), -10, work) == Approx(least));
        const auto found = tree.deepest(moved, 0, 4, work);
        if (fires) CHECK_FALSE(found.empty());
        none += found.empty();
        for (std::size_t k = 0; k < found.size(); ++k) {
            CHECK(found[k].gap == Approx(gapOf(tests[found[k].test], moved.pose())));
            if (k > 0) CHECK(found[k - 1].gap <= found[k].gap);
        }
    }
    CHECK(none > 10);
    CHECK(none < 190);
    CHECK(work < 200 * tests.size() / 10);
}

TEST_CASE("that nothing is nested is shown with few looks at the tests, however many there are") {
    const AllPairs pair;
    const std::vector<verify::MeshTest> tests = verify::meshTests(pair.table());
    const verify::VerifiedBody a(pair.a), b(pair.b);
    const verify::NestingResult result = proveNoNesting(a, b, pair.motion, 10, tests, 0.05, {});
    INFO(result.reason);
    CHECK(result.cells > 10);
    CHECK(result.work < result.cells * tests.size() / 20);
}
