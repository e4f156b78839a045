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

TEST_CASE("the nearest triangle that faces a way is found as by looking at all of them") {
    TriangleMesh mesh = ballMesh(Vec3(0.3, -0.2, 0.1), 1, 2);
    const TriangleMesh inner = ballMesh(Vec3(0.2, -0.2, 0.1), 0.4, 2);
    const auto first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    for (const Tri& t : inner.triangles) mesh.triangles.push_back(Tri(t[1], t[0], t[2]).array() + first);
    mesh.triangles.emplace_back(0, 0, 1); // without area: faces nothing, and may yet be nearest
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> along(-1.6, 1.6);
    for (const double far : {0.0, 1e4}) { // what a float cannot hold is not passed over
        TriangleMesh moved = mesh;
        for (Vec3& v : moved.vertices) v.array() += far;
        const ClosestPointQuery locator(moved);
        for (int i = 0; i < 500; ++i) {
            const Vec3 x = Vec3(along(random), along(random), along(random)).array() + far,
                       facing(along(random), along(random), along(random));
            const double range = 0.3 + 0.1 * (i % 10);
            double nearest = range, nearestFacing = range;
            for (const Tri& t : moved.triangles) {
                const Vec3 &a = moved.vertices[t[0]], &b = moved.vertices[t[1]], &c = moved.vertices[t[2]];
                const Vec3 w = nearestOnTriangle(x, a, b, c);
                const double d = (x - (w[0] * a + w[1] * b + w[2] * c)).norm();
                nearest = std::min(nearest, d);
                if ((b - a).cross(c - a).dot(facing) > 0) nearestFacing = std::min(nearestFacing, d);
            }
            const NearestPoint any = locator.nearest(x, range),
                               faces = locator.nearestFacing(x, range, facing);
            CHECK((any.triangle < 0 ? range : any.distance) == nearest);
            CHECK((faces.triangle < 0 ? range : faces.distance) == nearestFacing);
        }
    }
}
