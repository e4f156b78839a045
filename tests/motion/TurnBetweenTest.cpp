#include "bake/motion/SmallSystems.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace tss;

TEST_CASE(
    "the turn from one direction to another is right to rounding, also where they are nearly opposite") {
    const Vec3 across = Vec3(0.3, -0.2, 0.9).normalized();
    const Vec3 from = across.unitOrthogonal();
    for (const double short_ : {0.0, 1e-16, 1e-14, 1e-12, 3.67e-6, 1e-9, 1e-7, 1e-3, 0.5, 2.0, 3.0}) {
        for (const double angle : {std::numbers::pi - short_, short_}) {
            const Vec3 to = 7 * (Eigen::AngleAxisd(angle, across) * from);
            const Eigen::Quaterniond turn = turnBetween(0.01 * from, to);
            INFO("turned by " << angle);
            CHECK(std::abs(turn.norm() - 1) < 1e-15);
            CHECK((turn * from - to.normalized()).norm() < 1e-15);
            CHECK(std::abs(Eigen::AngleAxisd(turn).angle() - angle) < 1e-7);
        }
    }
}
