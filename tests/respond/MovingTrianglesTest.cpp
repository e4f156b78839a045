#include "bake/respond/MovingTriangles.h"
#include "tests/Shapes.h"

#include <catch2/catch.hpp>
#include <random>

using namespace tss;

namespace {

/// The nearest of all triangles that count, looked at one by one.
MovingTriangles::Met byBruteForce(const MovingTriangles& triangles, const Vec3& x, const Vec3& facing,
                                  double reach, bool onlyChanged, const Vec3* move) {
    MovingTriangles::Met best;
    best.distance = 1e9;
    const TriangleMesh& mesh = triangles.now();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        bool changed = false;
        for (const int v : mesh.triangles[t]) changed = changed || mesh.vertices[v] != triangles.rest()[v];
        if ((onlyChanged && !changed) || (!facing.isZero(0) && !(mesh.areaNormal(t).dot(facing) > 0)))
            continue;
        const Vec3 w = nearestOnTriangle(x, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
        Vec3 p = Vec3::Zero(), against = move ? *move : Vec3::Zero();
        for (int k = 0; k < 3; ++k) {
            p += w[k] * mesh.corner(t, k);
            if (move) against -= w[k] * triangles.moveOf(static_cast<std::size_t>(mesh.triangles[t][k]));
        }
        const double distance = (x - p).norm(), half = against.norm() / 2;
        if (distance < reach + half && distance < best.distance)
            best = {NearestPoint{static_cast<int>(t), w, p, distance}, half};
    }
    return best;
}

} // namespace

TEST_CASE("a skin on its way tells which of its triangles came near, as looking at each does") {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> along(-1, 1);
    const auto anywhere = [&] { return Vec3(along(random), along(random), along(random)); };
    const TriangleMesh ball = ballMesh(Vec3(0.3, -0.2, 0.1), 1, 2);
    MovingTriangles triangles(ball);
    std::size_t met = 0, none = 0, passed = 0;
    for (int station = 0; station < 4; ++station) {
        std::vector<Vec3> places = triangles.now().vertices;
        const Vec3 shift = 0.2 * anywhere();
        for (std::size_t v = 0; v < places.size(); ++v)
            if (ball.vertices[v].x() > 0.3) places[v] += shift + 0.05 * anywhere(); // the others stay at rest
        triangles.moveTo(places, std::vector<Vec3>(triangles.now().vertices));
        for (int i = 0; i < 300; ++i) {
            const Vec3 x = 1.3 * anywhere(), move = 0.3 * anywhere();
            const Vec3 facing = i % 3 == 0 ? Vec3(0, 0, 0) : anywhere();
            const Vec3* const way = i % 2 == 0 ? &move : nullptr;
            const bool onlyChanged = i % 5 == 0;
            const auto found = triangles.nearest(x, facing, 0.2, onlyChanged, way);
            const auto expected = byBruteForce(triangles, x, facing, 0.2, onlyChanged, way);
            REQUIRE((found.triangle < 0) == (expected.triangle < 0));
            MovingTriangles::Group group;
            group.places.extend(x);
            group.facings.extend(facing);
            if (way) group.moves.extend(move);
            if (found.triangle < 0) {
                ++none;
                continue;
            }
            ++met;
            passed += found.distance > 0.2;
            CHECK(found.distance == Approx(expected.distance));
            CHECK(found.half == Approx(expected.half));
            CHECK(triangles.mayMeet(group, 0.2, onlyChanged));
        }
    }
    CHECK(met > 100);
    CHECK(none > 100);
    CHECK(passed > 20);
}

TEST_CASE("the back of what moves along does not hide what was passed on the way") {
    // A finger 1 thick, and a palm 2 below it, which it comes down to by 3: its own back is nearer.
    TriangleMesh finger = boxMesh({-1, -1, 0}, {1, 1, 1});
    const TriangleMesh palm = boxMesh({-2, -2, -4}, {2, 2, -2});
    const auto fingers = finger.vertices.size(), backs = finger.triangles.size();
    finger.vertices.insert(finger.vertices.end(), palm.vertices.begin(), palm.vertices.end());
    for (const Tri& t : palm.triangles) finger.triangles.push_back(t.array() + static_cast<int>(fingers));
    MovingTriangles skin(finger);
    std::vector<Vec3> before = finger.vertices;
    const Vec3 down(0, 0, -3);
    for (std::size_t v = 0; v < fingers; ++v) before[v] -= down;
    skin.moveTo(finger.vertices, before);
    const auto found = skin.nearest({0, 0, 0}, {0, 0, 1}, 0.6, false, &down);
    REQUIRE(found.triangle >= static_cast<int>(backs));
    CHECK(found.distance == Approx(2));
    CHECK(found.half == Approx(1.5));
    CHECK(skin.nearest({0, 0, 0}, {0, 0, 1}, 0.6, false).triangle == -1);
}
