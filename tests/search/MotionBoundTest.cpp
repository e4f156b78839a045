#include "bake/motion/MotionBound.h"
#include "tests/search/RandomCells.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;

TEST_CASE("no point moves farther in a cell, or farther from its tangent, than the bounds say") {
    scenes::Random random(5);
    double tightestMove = 0, tightestRemainder = 0;
    for (int round = 0; round < 3000; ++round) {
        const int dofs = 1 + random.below(6);
        const Motion motion = cells::randomChain(random, dofs);
        const MotionRates rates(motion);
        const Cell cell = round % 2 ? cells::randomCell(random, motion) : cells::cutCell(random, motion);
        const CellMotion bound(rates, cell);
        const Vec3 y = random.inBox(2), z = random.inBox(2);
        const Vec3 x0 = bound.centrePose() * y, difference0 = bound.centrePose() * z - x0;
        const auto moved = bound.pointMotion(x0);
        std::array<std::array<double, maxDofs>, 3> jacobian;
        for (int axis = 0; axis < 3; ++axis) bound.slope(x0, Vec3::Unit(axis), jacobian[axis].data());
        for (int k = 0; k < 20; ++k) {
            const auto q = cells::inside(random, cell, motion.dofCount());
            const Vec3 x = pose(motion, q) * y, difference = pose(motion, q) * z - x;
            Vec3 tangent = x0;
            for (int axis = 0; axis < 3; ++axis)
                for (std::size_t l = 0; l < q.size(); ++l)
                    tangent[axis] += jacobian[axis][l] * (q[l] - bound.centre()[l]);
            INFO("round " << round << " dofs " << dofs);
            REQUIRE((x - x0).norm() <= moved.move + 1e-12);
            REQUIRE((x - tangent).norm() <= moved.remainder + 1e-12);
            REQUIRE((difference - difference0).norm() <= bound.relativeMove() * difference0.norm() + 1e-12);
            if (moved.move > 1e-6) tightestMove = std::max(tightestMove, (x - x0).norm() / moved.move);
            if (moved.remainder > 1e-6)
                tightestRemainder = std::max(tightestRemainder, (x - tangent).norm() / moved.remainder);
        }
        const auto share = bound.shares(x0);
        CHECK(std::accumulate(share.begin(), share.end(), 0.0) == Approx(moved.move).margin(1e-15));
    }
    // Bounds that nothing ever comes near would be useless.
    CHECK(tightestMove > 0.9);
    CHECK(tightestRemainder > 0.5);
}

TEST_CASE("a path is cut at its knots first, other DOFs in the middle") {
    scenes::Random random(2);
    Motion motion;
    motion.dofs = {scenes::path(random, 5, 0.1, 0.1), joints::slide({1, 0, 0}, 0, 1)};
    const MotionRates rates(motion);
    CHECK(rates.cut(0, 0, 4) == 2);
    CHECK(rates.cut(0, 0, 2.5) == 1);
    CHECK(rates.cut(0, 1, 2) == 1.5);
    CHECK(rates.cut(1, 0, 1) == 0.5);
}
