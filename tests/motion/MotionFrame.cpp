#include "bake/motion/MotionFrame.h"
#include "tests/table/RandomTable.h"

#include <catch2/catch.hpp>

using namespace tss;
using random_table::Random;

TEST_CASE("a joint's frame is its pose, and its twists are the derivatives of points") {
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Motion m = random_table::motion(random, 1 + int(random() % 4), 10);
        const std::vector<double> q = random_table::values(random, m);
        DofValues way{};
        for (std::size_t k = 0; k < q.size(); ++k) way[k] = random() % 2 ? 1 : -1;
        MotionFrame frame;
        evaluateFrame(m, q.data(), way.data(), frame);
        REQUIRE(frame.pose.matrix() == pose(m, q).matrix());
        const Vec3 y = random_table::inBall(random, 10), x = frame.pose * y;
        for (std::size_t k = 0; k < q.size(); ++k) {
            CAPTURE(k);
            std::vector<double> ahead = q;
            const double h = way[k] * 1e-7;
            ahead[k] += h;
            const Vec3 difference = (pose(m, ahead) * y - x) / h;
            REQUIRE((frame.twists[k].velocity(x) - difference).norm() < 1e-4 * (10 + difference.norm()));
        }
    }
}

TEST_CASE("no point moves faster than its speed bounds") {
    double tightest = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        const Motion m = random_table::motion(random, 1 + int(random() % 4), 10);
        const Vec3 y = random_table::inBall(random, 10);
        DofValues bounds;
        speedBounds(m, y, bounds.data());
        for (int i = 0; i < 50; ++i) {
            const std::vector<double> q = random_table::values(random, m);
            DofValues way;
            way.fill(1);
            MotionFrame frame;
            evaluateFrame(m, q.data(), way.data(), frame);
            const Vec3 x = frame.pose * y;
            for (std::size_t k = 0; k < q.size(); ++k) {
                const double speed = frame.twists[k].velocity(x).norm();
                REQUIRE(speed <= bounds[k] * (1 + 1e-12));
                REQUIRE(frame.twists[k].turn.norm() <= turnBound(m.dofs[k]) + 1e-12);
                tightest = std::max(tightest, speed / bounds[k]);
            }
        }
    }
    CHECK(tightest > 0.99);
}

TEST_CASE("a path's next row lies ahead of a value, also at a row") {
    Random random(3);
    const Dof dof = random_table::path(random, 1);
    CHECK(nextRow(dof, 0.0, 1) == dof.path[1].value);
    CHECK(nextRow(dof, dof.path[1].value, 1) == dof.path[2].value);
    CHECK(nextRow(dof, dof.path[1].value, -1) == dof.path[0].value);
    CHECK(nextRow(dof, 0.0, -1) == -HUGE_VAL);
    CHECK(nextRow(dof, 1.0, 1) == HUGE_VAL);
}

TEST_CASE("just before a path's row both segments' twists are told, on it and away from it the one ahead") {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        Random random(seed);
        CAPTURE(seed);
        Motion m = random_table::motion(random, 2, 10);
        m.dofs[1] = random_table::path(random, 1);
        m.dofs[1].lower = m.dofs[1].path.front().value;
        m.dofs[1].upper = m.dofs[1].path.back().value;
        const double row = m.dofs[1].path[1].value,
                     hair = 1e-10 * (m.dofs[1].path.back().value - m.dofs[1].path.front().value);
        const Vec3 y = random_table::inBall(random, 10);
        const double outer = 0.5 * (m.dofs[0].lower + m.dofs[0].upper);
        const auto velocityAt = [&](double value, double way, double from) {
            const double h = 1e-6 * way;
            return Vec3((pose(m, std::vector<double>{outer, value + from + h}) * y -
                         pose(m, std::vector<double>{outer, value + from}) * y) /
                        h);
        };
        for (const double way : {1.0, -1.0}) {
            const DofValues direction{way, way};
            MotionFrame frame;
            const auto at = [&](double value) {
                const DofValues q{outer, value};
                evaluateFrame(m, q.data(), direction.data(), frame);
                return frame.pose * y;
            };
            Vec3 x = at(row - way * hair);
            const Vec3 behind = velocityAt(row, way, -2e-6 * way), ahead = velocityAt(row, way, 0);
            REQUIRE(frame.rowAhead);
            CHECK((frame.twistsBeforeRow[1].velocity(x) - behind).norm() < 1e-3 * (1 + behind.norm()));
            CHECK((frame.twists[1].velocity(x) - ahead).norm() < 1e-3 * (1 + ahead.norm()));
            CHECK(frame.twistsBeforeRow[0].velocity(x) == frame.twists[0].velocity(x));
            x = at(row);
            CHECK_FALSE(frame.rowAhead);
            CHECK((frame.twists[1].velocity(x) - ahead).norm() < 1e-3 * (1 + ahead.norm()));
            at(row - way * 100 * hair);
            CHECK_FALSE(frame.rowAhead);
        }
    }
}
