#include "bake/spheres/Growth.h"

#include "bake/spheres/GenerateSpheres.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

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
    const GrowthTrace trace = growSphere(mesh, 0, lengths(0.1, 0.01, 10, 10));
    REQUIRE(trace.met.size() == 4);
    CHECK(trace.met == std::vector<int>{0, 1, 2, 3});
    REQUIRE(trace.stages.size() == 3);
    SECTION("from m1 along -N until m2 is in reach (Figure 1f)") {
        const GrowthStage& stage = trace.stages[0];
        CHECK(stage.anchor.norm() < 1e-12);
        CHECK(stage.direction.z() == Approx(-1));
        CHECK(stage.met == 1);
        CHECK(stage.t == Approx(1).margin(0.011));
        CHECK(stage.radius == Approx(stage.t));
    }
    SECTION("from the middle of m1 and m2 through the centre so far (Figure 1g)") {
        const GrowthStage& stage = trace.stages[1];
        CHECK((stage.anchor - 0.5 * (centroid(mesh, 0) + centroid(mesh, 1))).norm() < 1e-12);
        CHECK(stage.met == 2);
        CHECK(stage.radius == Approx((stage.centre - centroid(mesh, 0)).norm()).margin(0.02));
    }
    SECTION("from the middle of m1, m2 and m3 (Figure 1h), ended by a fourth (Figure 1i)") {
        const GrowthStage& stage = trace.stages[2];
        CHECK((stage.anchor - (centroid(mesh, 0) + centroid(mesh, 1) + centroid(mesh, 2)) / 3).norm() <
              1e-12);
        CHECK(stage.met == 3);
    }
    SECTION("the sphere kept does not hold the fourth") {
        CHECK((trace.sphere.centre - centroid(mesh, 3)).norm() >= trace.sphere.radius);
        for (int m = 0; m < 3; ++m)
            CHECK((trace.sphere.centre - centroid(mesh, m)).norm() <= trace.sphere.radius * (1 + 1e-9));
    }
}

TEST_CASE("growth stops at the threshold radius and at the end of the line") {
    const TriangleMesh mesh = trianglesAt({{0, 0, 0}, {0, 0, -2}});
    const GrowthTrace narrow = growSphere(mesh, 0, lengths(0.1, 0.1, 10, 0.55));
    CHECK_FALSE(narrow.bounded);
    CHECK(narrow.sphere.radius == Approx(0.5));
    const GrowthTrace shortLine = growSphere(mesh, 0, lengths(0.1, 0.1, 0.35, 10));
    CHECK(shortLine.sphere.radius == Approx(0.3));
    const GrowthTrace none = growSphere(mesh, 0, lengths(0.1, 0.1, 10, 0.05));
    CHECK(none.sphere.radius == 0);
    CHECK(none.stages.empty());
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
    const std::vector<GrowthTrace> traces = growSpheres(wedge, options);
    REQUIRE(traces.size() > 20);
    for (const GrowthTrace& t : traces) CHECK(t.sphere.centre.x() < 1.6);
    options.keepUnbounded = true;
    CHECK(growSpheres(wedge, options).size() > traces.size());
}

TEST_CASE("triangles met by a sphere seed no sphere of their own unless asked to") {
    std::mt19937_64 random(1);
    const TriangleMesh mesh = lumpyMesh(random, 3, 0.3);
    GrowthOptions options = lengths(0.02, 0.02, 10, 10);
    const std::vector<GrowthTrace> few = growSpheres(mesh, options);
    options.seedEveryTriangle = true;
    const std::vector<GrowthTrace> all = growSpheres(mesh, options);
    CHECK(all.size() == mesh.triangles.size());
    CHECK(few.size() < all.size());
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
