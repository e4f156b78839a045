#include "bake/geometry/MeshQuery.h"

#include "bake/base/Error.h"
#include "bake/geometry/TriangleDistance.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

/// By golden section over both barycentric coordinates: slow, and another way than the one under test.
double sampledDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto along = [&](double u) {
        const Vec3 from = a + u * (b - a), to = a + u * (c - a);
        const double l2 = (to - from).squaredNorm();
        const double t = l2 > 0 ? std::clamp((p - from).dot(to - from) / l2, 0.0, 1.0) : 0.0;
        return (from + t * (to - from) - p).norm();
    };
    double lo = 0, hi = 1; // convex in u
    for (int i = 0; i < 200; ++i) {
        const double m1 = lo + (hi - lo) / 3, m2 = hi - (hi - lo) / 3;
        (along(m1) < along(m2) ? hi : lo) = along(m1) < along(m2) ? m2 : m1;
    }
    return std::min({along(0), along(1), along(lo)});
}

double bruteDistance(const TriangleMesh& mesh, const Vec3& p) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        best = std::min(
            best, (closestOnTriangle(p, mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)) - p).norm());
    return best;
}

TriangleMesh closedOrSoup(std::uint64_t seed, std::mt19937_64& random) {
    return seed % 2 ? lumpyMesh(random, 3, 0.3) : soupMesh(random, 300, 1, 0.2);
}

} // namespace

TEST_CASE("the nearest point of a triangle agrees with a search over it, slivers and segments included") {
    const std::uint64_t seed = GENERATE(1u, 2u, 3u);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 300; ++i) {
        const Vec3 a = uniformPoint(random, 1), b = uniformPoint(random, 1);
        Vec3 c = uniformPoint(random, 1);
        if (i % 3 == 1)
            c = a + uniform(random, 0, 1) * (b - a) + uniformPoint(random, std::pow(10, -(i % 17)));
        if (i % 30 == 2) c = b;
        const Vec3 p = uniformPoint(random, i % 2 ? 2.0 : 1e3);
        CAPTURE(i, a.transpose(), b.transpose(), c.transpose(), p.transpose());
        CHECK((closestOnTriangle(p, a, b, c) - p).norm() ==
              Approx(sampledDistance(p, a, b, c)).epsilon(1e-9));
    }
}

TEST_CASE("the nearest point of a mesh is the best of all its triangles") {
    const std::uint64_t seed = GENERATE(4u, 5u);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const TriangleMesh mesh = closedOrSoup(seed, random);
    const MeshQuery query(mesh);
    for (int i = 0; i < 300; ++i) {
        const Vec3 p = uniformPoint(random, 1.5);
        const double expected = bruteDistance(mesh, p);
        const ClosestPoint found = query.closest(p);
        CHECK(found.distance == Approx(expected).epsilon(1e-12));
        CHECK((found.point - p).norm() == Approx(found.distance).epsilon(1e-12));
        CHECK(found.triangle >= 0);
        CHECK(query.closest(p, expected * 0.999).triangle == -1);
        CHECK(query.distance(p, expected * 1.001) == Approx(expected).epsilon(1e-12));
    }
}

TEST_CASE("what comes within a distance is what is nearer") {
    const std::uint64_t seed = GENERATE(8u, 9u);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const TriangleMesh mesh = closedOrSoup(seed, random);
    const MeshQuery query(mesh);
    int near = 0;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 p = uniformPoint(random, 3);
        const double distance = query.distance(p), within = uniform(random, 0, 4);
        if (std::abs(distance - within) < 1e-9) continue; // rounding may tell either
        CAPTURE(i, distance, within);
        CHECK(query.comesWithin(p, within) == (distance < within));
        near += distance < within;
    }
    CHECK(near > 500);
    CHECK(near < 1900);
    CHECK_FALSE(query.comesWithin({0, 0, 0}, 0));
    CHECK_FALSE(MeshQuery(TriangleMesh{}).comesWithin({0, 0, 0}, 1));
}

TEST_CASE("distances are right far from the origin and for tiny meshes") {
    const Eigen::Affine3d far(Eigen::Translation3d(1e7, -1e7, 1e7));
    const MeshQuery moved(transformed(boxMesh({0, 0, 0}, {1, 1, 1}), far));
    // A coordinate at 1e7 is 2e-9 wide: nothing is lost beyond that.
    CHECK(moved.distance(far * Vec3(0.5, 0.5, 0.25)) == Approx(0.25).margin(1e-8));
    CHECK(moved.inside(far * Vec3(0.5, 0.5, 1e-4)));
    CHECK_FALSE(moved.inside(far * Vec3(0.5, 0.5, -1e-4)));
    const MeshQuery tiny(boxMesh({0, 0, 0}, Vec3::Constant(1e-6)));
    CHECK(tiny.distance(Vec3(5e-7, 5e-7, 3e-7)) == Approx(3e-7).epsilon(1e-12));
    CHECK(tiny.inside(Vec3(5e-7, 5e-7, 1e-12)));
}

TEST_CASE("inside is the union of closed components, whichever way they are turned") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {2, 2, 2});
    append(mesh, boxMesh({1, 1, 1}, {3, 3, 3}));
    const bool inverted = GENERATE(false, true);
    const MeshQuery query(inverted ? turnedInsideOut(mesh) : mesh);
    CHECK(query.inside({0.5, 0.5, 0.5}));
    CHECK(query.inside({1.5, 1.5, 1.5})); // in both
    CHECK(query.inside({2.5, 2.5, 2.5}));
    CHECK_FALSE(query.inside({0.5, 2.5, 0.5}));
    CHECK_FALSE(query.inside({-0.5, 0.5, 0.5}));
    CHECK(std::abs(query.windingNumber({1.5, 1.5, 1.5})) == Approx(2));
}

TEST_CASE("a hundred shells on one another do not make an inside of what is outside") {
    TriangleMesh shells;
    const TriangleMesh one =
        transformed(ballMesh(Vec3::Zero(), 1, 2), Eigen::Affine3d(Eigen::Scaling(Vec3(1, 0.5, 0.2))));
    for (int k = 0; k < 100; ++k)
        append(shells, transformed(one, Eigen::Affine3d(Eigen::Scaling(1 - 1e-4 * k))));
    const MeshQuery query(shells), outermost(one);
    std::mt19937_64 random(4);
    int wrong = 0, in = 0;
    for (int k = 0; k < 4000; ++k) {
        const Vec3 p = uniformPoint(random, 1.5);
        if (outermost.distance(p) < 0.02) continue;
        wrong += query.inside(p) != outermost.inside(p);
        in += query.inside(p);
    }
    CHECK(wrong == 0);
    CHECK(in > 30);
}

TEST_CASE("the fast winding number tells in from out like the radius of a lumpy ball") {
    std::mt19937_64 random(7);
    const TriangleMesh mesh = lumpyMesh(random, 4, 0.3);
    const MeshQuery query(mesh);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p = uniformPoint(random, 1.2);
        // Star-shaped about the origin: outside where the way from there crosses the surface.
        const bool outside = segmentMeets(Vec3::Zero(), p, mesh);
        CHECK(query.inside(p) == !outside);
    }
}

TEST_CASE("a box without a lid is inside below its middle") {
    TriangleMesh mesh = boxMesh({-1, -1, -1}, {1, 1, 1});
    mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
    const MeshQuery query(mesh);
    CHECK(query.inside({0, 0, -0.5}));
    CHECK_FALSE(query.inside({0, 0, 1.5}));
    CHECK_FALSE(query.inside({0, 0, -1.5}));
}

TEST_CASE("a mesh of nothing is near nothing") {
    const MeshQuery query(TriangleMesh{});
    CHECK(query.closest({0, 0, 0}).triangle == -1);
    CHECK_FALSE(query.inside({0, 0, 0}));
}

TEST_CASE("a mesh with a bad index is refused") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    mesh.triangles[0][0] = 8;
    CHECK_THROWS_AS(MeshQuery(mesh), InputError);
}

TEST_CASE("many triangles at one place do not break the hierarchy") {
    TriangleMesh mesh;
    for (int i = 0; i < 1000; ++i) append(mesh, boxMesh({0, 0, 0}, {1, 1, 1}));
    const MeshQuery query(mesh);
    CHECK(query.distance({2, 0.5, 0.5}) == Approx(1));
}

TEST_CASE("the distance of two triangles is that of their nearest points, 0 where they cross") {
    std::mt19937_64 random(6);
    int crossing = 0;
    for (int i = 0; i < 400; ++i) {
        Corners s, t;
        for (int k = 0; k < 3; ++k) {
            s[k] = uniformPoint(random, 1);
            t[k] = uniformPoint(random, 1) + Vec3(i % 3, 0, 0);
        }
        if (i % 7 == 0) s[2] = s[0] + uniform(random, 0, 1) * (s[1] - s[0]); // a segment
        if (i % 31 == 0) s[2] = s[1] = s[0];                                 // a point
        const double distance = std::sqrt(squaredDistanceOfTriangles(s, t));
        CHECK(distance == Approx(std::sqrt(squaredDistanceOfTriangles(t, s))).margin(1e-12));
        // Sampled on one of them, nearest on the other: no less, and no more than a sample is off.
        constexpr int steps = 40;
        double sampled = std::numeric_limits<double>::infinity(), longest = 0;
        for (int k = 0; k < 3; ++k) longest = std::max(longest, (s[(k + 1) % 3] - s[k]).norm());
        for (int u = 0; u <= steps; ++u)
            for (int v = 0; u + v <= steps; ++v) {
                const Vec3 x = (u * s[0] + v * s[1] + (steps - u - v) * s[2]) / steps;
                sampled = std::min(sampled, (closestOnTriangle(x, t[0], t[1], t[2]) - x).norm());
            }
        CAPTURE(i, distance, sampled);
        CHECK(distance <= sampled + 1e-12);
        CHECK(sampled <= distance + longest / steps);
        crossing += distance == 0;
    }
    CHECK(crossing > 10);
}

TEST_CASE(
    "triangles are surely beyond a distance only where they are, and mostly where they are well beyond it") {
    std::mt19937_64 random(8);
    int beyond = 0, told = 0;
    for (int i = 0; i < 4000; ++i) {
        // Flat ones side by side in one plane, as of two plates, and any; some of them slivers, or far away.
        const double height = i % 2 == 0 ? 0 : 1;
        const Vec3 place = i % 5 == 0 ? Vec3(1e4, -1e4, 1e4) : Vec3::Zero();
        Corners s, t;
        for (int k = 0; k < 3; ++k) {
            s[k] = uniformPoint(random, 1).cwiseProduct(Vec3(1, 1, height)) + place;
            t[k] = (uniformPoint(random, 1) + Vec3(2, 0, 0)).cwiseProduct(Vec3(1, 1, height)) + place;
        }
        if (i % 7 == 0) s[2] = s[0] + uniform(random, 0, 1) * (s[1] - s[0]);
        if (i % 31 == 0) s[2] = s[1] = s[0];
        const double squared = squaredDistanceOfTriangles(s, t);
        CAPTURE(i, squared);
        CHECK_FALSE(surelyBeyond(s, t, squared));
        CHECK_FALSE(surelyBeyond(t, s, squared));
        if (!(squared > 0)) continue;
        ++beyond;
        told += surelyBeyond(s, t, squared / 4);
    }
    CHECK(beyond > 1000);
    CHECK(told > 0.8 * beyond);
}

TEST_CASE("edges that cross nearly parallel are as far apart as where they cross") {
    for (double angle = 1e-10; angle < 1e-3; angle *= 3)
        for (const double apart : {0.0, 1e-9, 0.3}) {
            const Vec3 along(1, 0, 0), askew(std::cos(angle), std::sin(angle), 0), up(0, 0, apart);
            const double distance =
                std::sqrt(squaredDistanceOfSegments(-along, 2 * along, up - 3 * askew, up + askew));
            CAPTURE(angle, apart);
            CHECK(distance >= apart * (1 - 1e-12));
            CHECK(distance <= apart + 3e-8);
        }
}

TEST_CASE("the distance of two meshes is the least of their triangles'") {
    std::mt19937_64 random(6);
    const TriangleMesh a = lumpyMesh(random, 2, 0.3), b = soupMesh(random, 40, 0.6, 0.4);
    const MeshQuery queryA(a), queryB(b);
    int far = 0, crossing = 0;
    for (int i = 0; i < 200; ++i) {
        Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
        pose.linear() =
            Eigen::AngleAxisd(uniform(random, 0, 3), uniformPoint(random, 1).normalized()).toRotationMatrix();
        pose.translation() = uniformPoint(random, 2.5);
        double expected = std::numeric_limits<double>::infinity();
        for (std::size_t t = 0; t < b.triangles.size(); ++t)
            for (std::size_t u = 0; u < a.triangles.size(); ++u)
                expected = std::min(
                    expected, squaredDistanceOfTriangles(
                                  {a.corner(u, 0), a.corner(u, 1), a.corner(u, 2)},
                                  {pose * b.corner(t, 0), pose * b.corner(t, 1), pose * b.corner(t, 2)}));
        expected = std::sqrt(expected);
        CAPTURE(i, expected);
        CHECK(queryA.distanceTo(queryB, pose) == Approx(expected).margin(1e-12));
        CHECK(queryB.distanceTo(queryA, pose.inverse()) == Approx(expected).margin(1e-12));
        crossing += expected == 0;
        if (expected == 0) {
            CHECK_FALSE(queryA.apart(queryB, pose, 1e-9));
            continue;
        }
        ++far;
        CHECK(queryA.apart(queryB, pose, expected * (1 - 1e-9)));
        CHECK_FALSE(queryA.apart(queryB, pose, expected * (1 + 1e-9)));
        CHECK(std::isinf(queryA.distanceTo(queryB, pose, expected * (1 - 1e-9))));
        CHECK(queryA.roughDistanceTo(queryB, pose) >= expected * (1 - 1e-12));
        CHECK(queryA.roughDistanceTo(queryB, pose) <= expected / 0.95);
        std::uint64_t looks = 0;
        CHECK(queryA.apart(queryB, pose, expected * (1 - 1e-9), &looks));
        CHECK_FALSE(queryA.apart(queryB, pose, expected * (1 - 1e-9), nullptr, looks / 2));
    }
    CHECK(far > 20);
    CHECK(crossing > 20);
}
