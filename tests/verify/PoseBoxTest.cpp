#include "bake/verify/PoseBox.h"

#include "tests/search/RandomCells.h"

#include <catch2/catch.hpp>

using namespace tss;

TEST_CASE("no point or direction moves farther in a box than the verifier's own bounds say") {
    scenes::Random random(11);
    double tightestMove = 0, tightestBend = 0;
    for (int round = 0; round < 6000; ++round) {
        const Motion motion = cells::randomChain(random, 1 + random.below(4));
        const Cell cell = round % 4 ? cells::cutCell(random, motion) : cells::randomCell(random, motion);
        const std::size_t dofs = motion.dofCount();
        const verify::PoseBox box(motion,
                                  {{cell.lower.begin(), cell.lower.begin() + dofs},
                                   {cell.upper.begin(), cell.upper.begin() + dofs}},
                                  verify::coordinateBound(motion, 4));
        const Vec3 y = random.inBox(2), direction = random.direction();
        const verify::MovingPoint point = box.carry(y, true);
        const Vec3 turned0 = box.pose().linear() * direction;
        for (int k = 0; k < 20; ++k) {
            const auto q = cells::inside(random, cell, dofs);
            const Pose at = pose(motion, q);
            Vec3 linear = point.at, linearTurned = turned0;
            for (std::size_t l = 0; l < dofs; ++l) {
                linear += point.velocity[l] * (q[l] - box.middle()[l]);
                linearTurned += box.spin(l).cross(turned0) * (q[l] - box.middle()[l]);
            }
            const double move = (at * y - point.at).norm(), bend = (at * y - linear).norm();
            INFO("round " << round << " dofs " << dofs);
            REQUIRE(move <= point.move);
            REQUIRE(bend <= point.bend);
            REQUIRE((at.linear() * direction - turned0).norm() <= box.turn());
            REQUIRE((at.linear() * direction - linearTurned).norm() <= box.turnBend());
            if (point.move > 1e-6) tightestMove = std::max(tightestMove, move / point.move);
            if (point.bend > 1e-6) tightestBend = std::max(tightestBend, bend / point.bend);
        }
    }
    // Bounds that nothing ever comes near would be useless.
    CHECK(tightestMove > 0.9);
    CHECK(tightestBend > 0.5);
}
