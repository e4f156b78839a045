#include "bake/spheres/SphereMethods.h"

#include "bake/spheres/GenerateSpheres.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

#include <set>

using namespace tss;
using namespace tss::test;

namespace {

Vec3 centroid(const TriangleMesh& mesh, int t) {
    const auto i = static_cast<std::size_t>(t);
    return (mesh.corner(i, 0) + mesh.corner(i, 1) + mesh.corner(i, 2)) / 3;
}

/// Four triangles, 0 in the plane z = 0 looking up and three below it that face it, centroids given.
TriangleMesh trianglesAt(const std::vector<Vec3>& centroids) {
    TriangleMesh mesh;
    for (const Vec3& c : centroids) {
        const auto first = static_cast<int>(mesh.vertices.size());
        for (const double angle : {0.0, 2.0, 4.0})
            mesh.vertices.push_back(c + 1e-3 * Vec3(std::cos(angle * std::numbers::pi / 3),
                                                    std::sin(angle * std::numbers::pi / 3), 0));
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    return mesh;
}

GrowthOptions lengths(double start, double step, double end, double maxRadius) {
    GrowthOptions options;
    options.relative = false;
    options.start = start;
    options.step = step;
    options.end = end;
    options.maxRadius = maxRadius;
    return options;
}

} // namespace

TEST_CASE("a sphere grows inwards until it meets a second, a third and a fourth centroid") {
    const TriangleMesh mesh = trianglesAt({{0, 0, 0}, {0, 0, -2}, {1.5, 0, -1.5}, {0, 2.2, -1.5}});
    const GrownSphere grown = growSpheres(mesh, lengths(0.1, 0.01, 10, 10)).at(0);
    CHECK(grown.met == std::vector<int>{0, 1, 2, 3});
    // m1, m2 and m3 are in the ball (Figure 1f-h), the fourth is not (1i).
    const auto away = [&](int t) { return (grown.sphere.centre - centroid(mesh, t)).norm(); };
    for (int m = 0; m < 3; ++m) CHECK(away(m) <= grown.sphere.radius * (1 + 1e-9));
    CHECK(std::max({away(0), away(1), away(2)}) == Approx(grown.sphere.radius));
    CHECK(away(3) >= grown.sphere.radius);
    CHECK(away(3) == Approx(grown.sphere.radius).margin(0.02));
}

TEST_CASE("growth stops at the end of the line, and at the threshold radius") {
    const TriangleMesh mesh = trianglesAt({{0, 0, 0}, {0, 0, -2}});
    const GrownSphere grown = growSpheres(mesh, lengths(0.1, 0.01, 1.05, 10)).at(0);
    CHECK(grown.met == std::vector<int>{0, 1});
    // On the second line, from the middle of the two.
    CHECK((grown.sphere.centre - Vec3(0, 0, -1)).norm() == Approx(1.05).margin(0.011));
    CHECK(growSpheres(mesh, lengths(0.1, 0.1, 10, 0.55)).empty()); // the threshold radius
    CHECK(growSpheres(mesh, lengths(0.1, 0.1, 0.35, 10)).empty()); // T_max
    CHECK(growSpheres(mesh, lengths(0.1, 0.1, 10, 0.05)).empty());
}

TEST_CASE("a small threshold puts spheres into the narrow region only") {
    // A slab with a wedge: thin at x = 0, thick at x = 4.
    TriangleMesh wedge;
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 10; ++j)
            for (const double side : {1.0, -1.0}) {
                const double x = 0.1 * i;
                wedge.vertices.emplace_back(x, 0.1 * j, side * (0.05 + 0.25 * x));
            }
    const auto index = [](int i, int j, int side) { return 2 * (11 * i + j) + side; };
    for (int i = 0; i < 40; ++i)
        for (int j = 0; j < 10; ++j) {
            wedge.triangles.emplace_back(index(i, j, 0), index(i + 1, j, 0), index(i + 1, j + 1, 0));
            wedge.triangles.emplace_back(index(i, j, 0), index(i + 1, j + 1, 0), index(i, j + 1, 0));
            wedge.triangles.emplace_back(index(i, j, 1), index(i + 1, j + 1, 1), index(i + 1, j, 1));
            wedge.triangles.emplace_back(index(i, j, 1), index(i, j + 1, 1), index(i + 1, j + 1, 1));
        }
    GrowthOptions options = lengths(0.02, 0.005, 10, 0.3);
    const std::vector<GrownSphere> narrow = growSpheres(wedge, options);
    REQUIRE(narrow.size() > 20);
    for (const GrownSphere& grown : narrow) CHECK(grown.sphere.centre.x() < 1.6);
    options.maxRadius = 10;
    CHECK(growSpheres(wedge, options).size() > narrow.size());
}

TEST_CASE("triangles met by a sphere seed no sphere of their own") {
    std::mt19937_64 random(1);
    const TriangleMesh mesh = lumpyMesh(random, 3, 0.3);
    const std::vector<GrownSphere> grown = growSpheres(mesh, lengths(0.02, 0.02, 10, 10));
    REQUIRE(grown.size() > 10);
    std::set<int> met;
    for (const GrownSphere& sphere : grown) {
        CHECK_FALSE(met.contains(sphere.met.front()));
        met.insert(sphere.met.begin(), sphere.met.end());
    }
}

TEST_CASE("the paper's lengths are fractions of the diagonal unless given in units") {
    std::mt19937_64 random(2);
    const TriangleMesh mesh = lumpyMesh(random, 3, 0.3);
    const double size = diagonal(mesh);
    const GrowthOptions paper;
    GrowthOptions units = lengths(0.01 * size, 0.01 * size, 0.101 * size, 0.02 * size);
    CHECK(growSpheres(mesh, paper).size() == growSpheres(mesh, units).size());
    SphereOptions options;
    options.method = SphereMethod::Growth;
    options.growth.maxRadius = 1;
    options.growth.end = 1;
    const SphereFit fit = fitSpheres(mesh, options);
    CHECK(fit.spheres.size() > 0);
    CHECK(fit.protrusion > 0);
}
