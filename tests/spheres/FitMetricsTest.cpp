#include "bake/spheres/FitMetrics.h"

#include "bake/spheres/GenerateSpheres.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

namespace {

double distanceToUnion(const SphereSet& spheres, const Vec3& x) {
    double best = std::numeric_limits<double>::infinity();
    for (const Sphere& s : spheres) best = std::min(best, (x - s.centre).norm() - s.radius);
    return std::max(0.0, best);
}

Vec3 pointOn(std::mt19937_64& random, const TriangleMesh& mesh, std::size_t t) {
    double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return mesh.corner(t, 0) + u * (mesh.corner(t, 1) - mesh.corner(t, 0)) +
           v * (mesh.corner(t, 2) - mesh.corner(t, 0));
}

SphereSet randomSpheres(std::mt19937_64& random, int count) {
    SphereSet spheres;
    for (int i = 0; i < count; ++i)
        spheres.push_back({uniformPoint(random, 1), std::pow(10, uniform(random, -3, -0.3))});
    return spheres;
}

} // namespace

TEST_CASE("no sampled point is farther from the spheres than the coverage, and some come near it") {
    const std::uint64_t seed = GENERATE(1u, 2u, 3u, 4u);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const TriangleMesh mesh = seed % 2 ? lumpyMesh(random, 3, 0.3) : soupMesh(random, 60, 1, 0.5);
    const SphereSet spheres = randomSpheres(random, seed < 3 ? 5 : 60);
    const FitMetrics fit = measureFit(Solid(mesh), spheres);
    double worst = 0;
    const int samples = 30000;
    for (int i = 0; i < samples; ++i) {
        const double d = distanceToUnion(spheres, pointOn(random, mesh, random() % mesh.triangles.size()));
        worst = std::max(worst, d);
    }
    CHECK(worst <= fit.coverage);
    CHECK(worst >= 0.9 * fit.coverage);
    CHECK(fit.coverageMean <= fit.coverage);
    CHECK(fit.coverageP95 <= fit.coverage);
}

TEST_CASE("the mean coverage is that of points thrown evenly over the surface") {
    std::mt19937_64 random(5);
    const TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    const SphereSet spheres = {{{0.2, 0.3, 0.4}, 0.3}};
    double sum = 0;
    const int samples = 20000;
    for (int i = 0; i < samples; ++i) sum += distanceToUnion(spheres, pointOn(random, mesh, random() % 12));
    CHECK(measureFit(Solid(mesh), spheres).coverageMean == Approx(sum / samples).epsilon(0.02));
}

TEST_CASE("no point of a sphere sticks out of the body farther than the protrusion") {
    const std::uint64_t seed = GENERATE(6u, 7u, 8u);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    TriangleMesh mesh = lumpyMesh(random, 3, 0.3);
    if (seed == 7)
        append(mesh, transformed(lumpyMesh(random, 2, 0.2), Eigen::Affine3d(Eigen::Translation3d(1, 0, 0))));
    if (seed == 8) mesh.triangles.resize(mesh.triangles.size() - 40);
    const Solid solid(mesh);
    const SphereSet spheres = randomSpheres(random, 40);
    const FitMetrics fit = measureFit(solid, spheres);
    double worst = 0;
    for (const Sphere& s : spheres)
        for (int i = 0; i < 300; ++i) {
            const Vec3 x = s.centre + s.radius * uniformPoint(random, 1).normalized();
            if (!solid.inside(x)) worst = std::max(worst, solid.boundary().distance(x));
        }
    CHECK(worst <= fit.protrusion * (1 + 1e-12));
    CHECK(fit.protrusionMean <= fit.protrusion);
    CHECK(worst > 0);
}

TEST_CASE("a sphere about a ball covers it, sticks out by the difference and has the ratio of volumes") {
    const FitMetrics fit = measureFit(Solid(ballMesh({1, 2, 3}, 1, 5)), SphereSet{{{1, 2, 3}, 1.25}});
    CHECK(fit.coverage == 0);
    CHECK(fit.protrusion == Approx(0.25).margin(2e-3));
    CHECK(fit.volumeRatio == Approx(1.25 * 1.25 * 1.25).epsilon(0.03));
}

TEST_CASE("the volume of a body of thin walls is measured as that of a thick one") {
    // A shell and a plate within it, thinner than what is looked at as a whole.
    TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, 5), inner = ballMesh(Vec3::Zero(), 0.97, 5);
    for (Tri& t : inner.triangles) std::swap(t[0], t[1]);
    append(mesh, inner);
    append(mesh, boxMesh({-0.5, -0.5, -0.01}, {0.5, 0.5, 0.01}));
    const double pi = std::acos(-1), shell = 4 / 3. * pi * (1 - std::pow(0.97, 3));
    CHECK(measureFit(Solid(mesh), SphereSet{{Vec3::Zero(), 1.1}}).volumeRatio ==
          Approx(4 / 3. * pi * std::pow(1.1, 3) / (shell + 0.02)).epsilon(0.05));
}

TEST_CASE("a part of the surface is measured by itself") {
    const TriangleMesh box = boxMesh({0, 0, 0}, {1, 1, 1});
    const Solid solid(box);
    const std::vector<Patch> patches = patchesOf(box);
    const SphereSet spheres = {{{0.5, 0.5, 0}, 0.75}};
    // The first two triangles are the face z = 0, which the sphere covers.
    CHECK(measureFit(solid, spheres, std::span(patches).first(2)).coverage == 0);
    CHECK(measureFit(solid, spheres, patches).coverage > 0.1);
}

TEST_CASE("no sphere at all covers nothing") {
    const Solid solid(boxMesh({0, 0, 0}, {1, 1, 1}));
    CHECK(std::isinf(measureFit(solid, SphereSet{}).coverage));
    CHECK(measureFit(solid, SphereSet{}).protrusion == 0);
}
