#include "bake/motion/ClosestPointQuery.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;

TEST_CASE("a way has entered a ball where it goes from outside of it to inside or beyond") {
    const TriangleMesh ball = ballMesh(Vec3(0.3, -0.2, 0.1), 1, 2);
    const ClosestPointQuery locator(ball);
    // A convex surface: inside is behind all triangles.
    const auto outside = [&](const Vec3& x) {
        for (const Tri& t : ball.triangles) {
            const Vec3& a = ball.vertices[t[0]];
            if ((ball.vertices[t[1]] - a).cross(ball.vertices[t[2]] - a).dot(x - a) > 0) return true;
        }
        return false;
    };
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> along(-1.6, 1.6);
    int in = 0, through = 0, past = 0, out = 0;
    for (int i = 0; i < 4000; ++i) {
        const Vec3 from(along(random), along(random), along(random)),
            to(along(random), along(random), along(random));
        bool meets = false;
        for (int k = 0; k <= 400 && !meets; ++k) meets = !outside(from + k / 400.0 * (to - from));
        const bool entered = locator.entered(from, to) >= 0;
        if (!outside(from)) {
            CHECK_FALSE(entered); // what goes out has not come in through a front
            ++out;
        } else if (!outside(to)) {
            CHECK(entered);
            ++in;
        } else if (meets) {
            CHECK(entered);
            ++through;
        } else {
            past += !entered; // but for what only grazes it between two of the places
        }
    }
    CHECK(in > 300);
    CHECK(through > 100);
    CHECK(past > 300);
    CHECK(out > 300);
    CHECK(locator.entered(Vec3(3, 0, 0), Vec3(3, 0, 0)) == -1);
    const TriangleMesh nothing;
    CHECK(ClosestPointQuery(nothing).entered(Vec3(3, 0, 0), Vec3(-3, 0, 0)) == -1);
}
