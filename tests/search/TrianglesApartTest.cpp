#include "bake/search/SurfacesApart.h"

#include "tests/Joints.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;
using namespace tss::test;

TEST_CASE("triangles told apart by the way they move stay apart at every pose of the cell") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    const auto vec = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
    int shown = 0, tight = 0, beyondMoves = 0;
    for (int round = 0; round < 6000; ++round) {
        const TriangleMesh a = soupMesh(random, 1, 0.3, 0.8), b = soupMesh(random, 1, 0.3, 0.8);
        Motion motion;
        motion.base = Pose(Eigen::Translation3d(0.9 * vec().normalized()));
        for (int k = 0; k < 1 + round % 3; ++k)
            motion.dofs.push_back((k + round) % 3 ? joints::turn(2 * vec(), vec(), -0.5, 0.5)
                                                  : joints::slide(vec(), -0.3, 0.3));
        const MeshQuery treeA(a), treeB(b);
        const MotionRates rates(motion);
        const CellMotion cell(rates, wholeBox(motion));
        const double distance = 0.05;
        std::uint64_t looked = 0;
        if (!trianglesApart(treeA, treeB, cell, distance, 1e-12, 1000, looked)) continue;
        ++shown;
        double least = 1e9;
        for (int i = 0; i < 300; ++i) {
            std::vector<double> q;
            for (const Dof& dof : motion.dofs)
                q.push_back(i < 8 ? ((i >> q.size()) & 1 ? dof.upper : dof.lower)
                                  : dof.lower + (dof.upper - dof.lower) * (unit(random) + 1) / 2);
            least = std::min(least, treeA.distanceTo(treeB, pose(motion, q), least));
        }
        if (least <= distance) FAIL("round " << round << ": " << least);
        tight += least < 1.5 * distance;
        const double move =
            cell.pointMotion(cell.centrePose() * treeB.centre()).move + cell.relativeMove() * treeB.radius();
        beyondMoves += !treeA.apart(treeB, cell.centrePose(), distance + move);
    }
    CHECK(shown > 300);
    CHECK(tight > 10);
    CHECK(beyondMoves > 100); // not to be told by how far points move alone
}

TEST_CASE("telling triangles apart ends where it was told to") {
    const MeshQuery ball(ballMesh(Vec3::Zero(), 1, 3)), other(ballMesh({2.001, 0, 0}, 1, 3));
    const Motion motion;
    const MotionRates rates(motion);
    const CellMotion cell(rates, wholeBox(motion));
    std::uint64_t looked = 0, all = 0;
    CHECK(trianglesApart(ball, other, cell, 0, 1e-12, 1'000'000, all));
    CHECK_FALSE(trianglesApart(ball, other, cell, 0, 1e-12, all - 1, looked));
    CHECK(looked <= all);
}
