#include "bake/motion/MotionBound.h"
#include "tests/search/Scenes.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;

namespace {

Motion randomChain(scenes::Random& random, int dofs) {
    Motion motion;
    for (int k = 0; k < dofs; ++k) switch (random.below(3)) {
        case 0:
            motion.dofs.push_back(joints::turn(random.inBox(2), random.direction(), -4, 4));
            break;
        case 1:
            motion.dofs.push_back(joints::slide(random.in(0.1, 3) * random.direction(), -2, 2));
            break;
        default:
            motion.dofs.push_back(
                scenes::path(random, 2 + random.below(6), random.in(0, 0.5), random.in(0, 1)));
        }
    motion.base.translation() = random.inBox(1);
    return motion;
}

Cell randomCell(scenes::Random& random, const Motion& motion) {
    Cell cell;
    const double size = std::pow(10.0, random.in(-3, 0));
    for (std::size_t k = 0; k < motion.dofCount(); ++k) {
        const Dof& dof = motion.dofs[k];
        const double width = random.below(8) ? size * (dof.upper - dof.lower) * random.in(0.1, 1) : 0;
        cell.lower[k] = random.in(dof.lower, dof.upper - width);
        cell.upper[k] = cell.lower[k] + width;
    }
    return cell;
}

std::vector<double> inside(scenes::Random& random, const Cell& cell, std::size_t dofs) {
    std::vector<double> q;
    for (std::size_t k = 0; k < dofs; ++k) switch (random.below(4)) { // corners are where bounds fail first
        case 0:
            q.push_back(cell.lower[k]);
            break;
        case 1:
            q.push_back(cell.upper[k]);
            break;
        default:
            q.push_back(random.in(cell.lower[k], cell.upper[k]));
        }
    return q;
}

} // namespace

TEST_CASE("no point moves farther in a cell, or farther from its tangent, than the bounds say") {
    scenes::Random random(5);
    double tightestMove = 0, tightestRemainder = 0;
    for (int round = 0; round < 3000; ++round) {
        const int dofs = 1 + random.below(6);
        const Motion motion = randomChain(random, dofs);
        const MotionRates rates(motion);
        const Cell cell = randomCell(random, motion);
        const CellMotion bound(rates, cell);
        const Vec3 y = random.inBox(2), z = random.inBox(2);
        const Vec3 x0 = bound.centrePose() * y, difference0 = bound.centrePose() * z - x0;
        const auto moved = bound.pointMotion(x0);
        std::array<std::array<double, maxDofs>, 3> jacobian;
        for (int axis = 0; axis < 3; ++axis) bound.slope(x0, Vec3::Unit(axis), jacobian[axis].data());
        for (int k = 0; k < 20; ++k) {
            const auto q = inside(random, cell, motion.dofCount());
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
