#include "bake/spheres/GenerateSpheres.h"
#include "tests/FloatTraps.h"

#include "bake/base/Error.h"
#include "bake/base/Parallel.h"
#include "bake/geometry/Import.h"
#include "bake/spheres/FitMetrics.h"
#include "bake/spheres/SphereMethods.h"
#include "tests/Shapes.h"
#include "tests/SharedMeshes.h"
#include "tests/geometry/TestMeshes.h"

using namespace tss;
using namespace tss::test;

namespace {

SphereOptions medial(double tolerance) {
    SphereOptions options;
    options.tolerance = tolerance;
    return options;
}

SphereSet spheresOf(const TriangleMesh& mesh, const SphereOptions& options) {
    return fitSpheres(mesh, options).spheres;
}

/// The spheres hold what they promise: they contain the surface and stick out at most by the tolerance.
void checkConservative(const TriangleMesh& mesh, const SphereFit& fit, double tolerance) {
    const FitMetrics metrics = measureFit(Solid(mesh), fit.spheres);
    CHECK(fit.spheres.size() > 0);
    CHECK(metrics.coverage == 0);
    CHECK(metrics.protrusion <= tolerance);
    CHECK(metrics.protrusion <= fit.protrusion * (1 + 1e-9));
    CHECK(fit.coverage == 0);
}

bool sameBits(const SphereSet& a, const SphereSet& b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](const Sphere& x, const Sphere& y) {
               return x.centre == y.centre && x.radius == y.radius;
           });
}

} // namespace

TEST_CASE("medial spheres contain the surface and stick out at most by the tolerance") {
    const std::uint64_t seed = GENERATE(1u, 2u, 3u);
    const double tolerance = GENERATE(0.1, 0.03);
    CAPTURE(seed, tolerance);
    std::mt19937_64 random(seed);
    const TriangleMesh mesh = lumpyMesh(random, 2, 0.4);
    checkConservative(mesh, fitSpheres(mesh, medial(tolerance)), tolerance);
}

TEST_CASE("bad meshes are filled as well as good ones") {
    std::mt19937_64 random(4);
    TriangleMesh mesh;
    std::string note;
    SECTION("one triangle") {
        mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        mesh.triangles = {{0, 1, 2}};
        note = "open";
    }
    SECTION("a sliver") {
        mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}};
        mesh.triangles = {{0, 1, 2}}; // its edges lie on each other: a seam, not an opening
    }
    SECTION("a soup") {
        mesh = soupMesh(random, 20, 1, 0.3);
        note = "open";
    }
    SECTION("a body with triangles missing") {
        mesh = lumpyMesh(random, 2, 0.3);
        mesh.triangles.resize(mesh.triangles.size() - 10);
        note = "open";
    }
    SECTION("a body inside out") {
        mesh = turnedInsideOut(lumpyMesh(random, 2, 0.3));
        note = "inside out";
    }
    SECTION("a body with some triangles turned over") {
        mesh = lumpyMesh(random, 2, 0.3);
        for (std::size_t t = 0; t < mesh.triangles.size(); t += 17)
            std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
        note = "misoriented";
    }
    SECTION("overlapping components") {
        mesh = lumpyMesh(random, 2, 0.3);
        append(mesh,
               transformed(lumpyMesh(random, 2, 0.3), Eigen::Affine3d(Eigen::Translation3d(0.8, 0.3, 0))));
    }
    SECTION("a sheet thinner than the tolerance") {
        mesh = boxMesh({0, 0, 0}, {1, 0.5, 1e-4});
    }
    SECTION("duplicates, triangles of no area and unused vertices") {
        mesh = boxMesh({0, 0, 0}, {1, 1, 1});
        mesh.triangles.push_back(mesh.triangles[0]);
        mesh.triangles.emplace_back(1, 1, 2);
        mesh.vertices.emplace_back(7, 7, 7);
    }
    const SphereFit fit = fitSpheres(mesh, medial(0.03));
    checkConservative(mesh, fit, 0.03);
    CHECK((note.empty() ? fit.note.empty() : fit.note.find(note) != std::string::npos));
    for (const Sphere& s : fit.spheres) CHECK((s.centre.allFinite() && s.radius > 0));
}

TEST_CASE("spheres of both sides of a thin plate do not reach through it") {
    // A centre in a feature thinner than the slack would leave it and grow without end.
    const TriangleMesh plate = boxMesh({0, 0, 0}, {1, 1, 1e-5});
    for (const Sphere& s : spheresOf(plate, medial(0.03))) CHECK(s.radius < 0.06);
}

TEST_CASE("what is no mesh gets no spheres but a reason") {
    const FloatTrapsOff traps; // what is not a number is handed over on purpose
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    CHECK_THROWS_AS(spheresOf({}, medial(0.1)), InputError);
    mesh.vertices[0].x() = std::nan("");
    CHECK_THROWS_AS(spheresOf(mesh, medial(0.1)), InputError);
}

TEST_CASE("options out of range are refused") {
    const TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    CHECK_THROWS_AS(spheresOf(mesh, medial(-1)), InputError);
    CHECK_THROWS_AS(spheresOf(mesh, medial(std::nan(""))), InputError);
    SphereOptions options = medial(0.1);
    options.maxSpheres = -1;
    CHECK_THROWS_AS(spheresOf(mesh, options), InputError);
}

TEST_CASE("inscribed spheres stay inside and leave at most the tolerance uncovered") {
    std::mt19937_64 random(5);
    const TriangleMesh mesh = lumpyMesh(random, 2, 0.4);
    SphereOptions options = medial(0.03);
    options.conservative = false;
    const SphereFit fit = fitSpheres(mesh, options);
    const FitMetrics metrics = measureFit(Solid(mesh), fit.spheres);
    CHECK(metrics.protrusion < 1e-12);
    CHECK(metrics.coverage <= 0.03 * 1.02);
    CHECK(metrics.coverage <= fit.coverage * 1.02);
    CHECK(fit.protrusion == 0);
}

TEST_CASE("plain shrinking balls are conservative too, and more") {
    std::mt19937_64 random(6);
    const TriangleMesh mesh = lumpyMesh(random, 2, 0.3);
    SphereOptions options = medial(0.03);
    options.method = SphereMethod::Shrinking;
    const SphereFit fit = fitSpheres(mesh, options);
    checkConservative(mesh, fit, 0.03);
    CHECK(fit.spheres.size() > 2 * spheresOf(mesh, medial(0.03)).size());
}

TEST_CASE("a finer tolerance takes more spheres, far fewer than there are triangles to cover") {
    std::mt19937_64 random(7);
    const TriangleMesh mesh = lumpyMesh(random, 3, 0.3);
    const std::size_t coarse = spheresOf(mesh, medial(0.1)).size(),
                      fine = spheresOf(mesh, medial(0.03)).size();
    CHECK(coarse < fine);
    CHECK(fine < 2 * mesh.triangles.size());
}

TEST_CASE("turning, moving and scaling a body does the same to its spheres") {
    const std::uint64_t seed = GENERATE(8u, 9u);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    const TriangleMesh mesh = lumpyMesh(random, 2, 0.3);
    const double scale = GENERATE(1.0, 1e-6, 1e6);
    CAPTURE(scale);
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    transform.translate(scale * Vec3(3, -5, 2)).scale(scale);
    transform.rotate(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()));
    const SphereSet before = spheresOf(mesh, medial(0.03));
    const SphereSet after = spheresOf(transformed(mesh, transform), medial(0.03 * scale));
    // Halves of equal edges and equal gains may be told apart otherwise, which moves the count a little.
    CHECK(static_cast<double>(after.size()) == Approx(static_cast<double>(before.size())).epsilon(0.05));
    SphereSet back = after;
    for (Sphere& s : back) s = {transform.inverse() * s.centre, s.radius / scale};
    const FitMetrics a = measureFit(Solid(mesh), before), b = measureFit(Solid(mesh), back);
    CHECK(b.coverage < 1e-9);
    CHECK(b.protrusion <= 0.03);
    CHECK(b.volumeRatio == Approx(a.volumeRatio).epsilon(0.01));
}

TEST_CASE("the number of threads does not change a bit") {
    std::mt19937_64 random(10);
    const TriangleMesh mesh = lumpyMesh(random, 3, 0.3);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return spheresOf(mesh, medial(0.03));
    };
    CHECK(sameBits(with(1), with(2)));
}

TEST_CASE("the best spheres for a number come near the number") {
    std::mt19937_64 random(11);
    const TriangleMesh mesh = lumpyMesh(random, 2, 0.3);
    SphereOptions options;
    options.maxSpheres = GENERATE(1, 30, 150);
    const SphereFit fit = fitSpheres(mesh, options);
    const auto limit = static_cast<std::size_t>(options.maxSpheres);
    CHECK(fit.spheres.size() <= limit);
    CHECK(fit.spheres.size() >= limit * 9 / 10);
    checkConservative(mesh, fit, fit.protrusion * (1 + 1e-9));
}

TEST_CASE("a tolerance that so few spheres cannot keep is said to be missed, with what was reached") {
    std::mt19937_64 random(12);
    const TriangleMesh mesh = lumpyMesh(random, 2, 0.3);
    SphereOptions options = medial(0.002);
    options.maxSpheres = 50;
    const SphereFit fit = fitSpheres(mesh, options);
    CHECK(fit.note.find("tolerance 0.002 not reached: 50 spheres allow") != std::string::npos);
    CHECK(fit.protrusion > 0.002);
    options.tolerance = 0.5;
    CHECK(fitSpheres(mesh, options).note.empty());
}

TEST_CASE("surface spheres stand on the vertices and cover the surface when asked to") {
    std::mt19937_64 random(13);
    const TriangleMesh mesh = lumpyMesh(random, 2, 0.3);
    SphereOptions options;
    options.method = SphereMethod::Surface;
    const SphereSet covering = spheresOf(mesh, options);
    CHECK(measureFit(Solid(mesh), covering).coverage == 0);
    options.conservative = false;
    const SphereSet plain = spheresOf(mesh, options);
    REQUIRE(plain.size() == mesh.vertices.size());
    for (std::size_t v = 0; v < plain.size(); ++v) CHECK(plain[v].centre == mesh.vertices[v]);
    // Every edge of an octahedron is as long as the next.
    for (const Sphere& s : spheresOf(ballMesh({0, 0, 0}, 1, 0), options))
        CHECK(s.radius == Approx(std::sqrt(2.0) / 2));
}

TEST_CASE("real meshes are filled within their tolerance") {
    REQUIRE_SHARED_MESHES();
    const auto [file, tolerance] =
        GENERATE(table<std::string, double>({{"dog_limbs/pelvis.obj", 0.004},
                                             {"human_jaw_ict/lower_teeth.obj", 0.2},
                                             {"human_finger/middle_phalanx.obj", 0.0005},
                                             {"franka_fer/link3.obj", 0.01},
                                             {"dog_jaw/mandible.obj", 0.004}}));
    CAPTURE(file);
    const TriangleMesh mesh = importMesh(sharedMesh(file));
    const SphereFit fit = fitSpheres(mesh, medial(tolerance));
    checkConservative(mesh, fit, tolerance);
    CHECK(fit.note.empty() == (file != "franka_fer/link3.obj"));
}

TEST_CASE("a body far away at rest changes no sphere, one nearby does") {
    std::mt19937_64 random(5);
    const Solid solid(lumpyMesh(random, 3, 0.3));
    const std::vector<Patch> patches = patchesOf(solid.mesh());
    constexpr double protrusion = 0.05, halfGap = 0.01;
    const MedialSet alone = medialSpheres(solid, patches, protrusion, {});
    const MeshQuery surface(solid.mesh());
    const auto beside = [&](double clearance) {
        const TriangleMesh wall = boxMesh({-3, -3, -3}, {3, 3, -2.9});
        auto neighbour = std::make_shared<RestNeighbour>();
        neighbour->toOther.translation().z() =
            clearance - surface.distanceTo(MeshQuery(wall), Eigen::Isometry3d::Identity());
        neighbour->body = std::make_shared<const MeshQuery>(wall);
        neighbour->halfGap = halfGap;
        neighbour->clearance = clearance;
        MedialOptions options;
        options.neighbour = neighbour;
        return medialSpheres(solid, patches, protrusion, options).spheres;
    };
    CHECK(sameBits(beside(3.1 * (protrusion + halfGap)), alone.spheres));
    CHECK_FALSE(sameBits(beside(protrusion / 2), alone.spheres));
}

TEST_CASE("of many small triangles few get a candidate of their own, and the choice is hardly worse") {
    constexpr double protrusion = 0.05;
    const Solid solid(ballMesh({0.1, 0, 0}, 1, 5));
    std::vector<Patch> patches = patchesOf(solid.mesh());
    const PatchOptions options{protrusion, 10'000'000};
    const FittedPatches all = fitPatches(solid, patches, options);
    const FittedPatches some = fitPatchesSparsely(solid, patches, options);
    const auto own = std::ranges::count_if(some.candidates, [](const Sphere& s) { return s.radius > 0; });
    CHECK(own > 0);
    CHECK(own < static_cast<std::ptrdiff_t>(all.candidates.size() / 10));
    const SphereSet few = chooseSpheres(all).spheres, chosen = chooseSpheres(some).spheres;
    CHECK(chosen.size() <= few.size() + few.size() / 5 + 2);
    const FitMetrics metrics = measureFit(solid, chosen);
    CHECK(metrics.coverage == 0);
    CHECK(metrics.protrusion <= protrusion * (1 + 1e-9));
}
