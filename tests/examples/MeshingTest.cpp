#include "examples/doghead/mesh/Meshing.h"
#include "bake/geometry/MeshAudit.h"
#include "examples/doghead/implicit/Curve.h"
#include "examples/doghead/mesh/EditableMesh.h"

#include <catch2/catch.hpp>

#include <random>

using namespace doghead;

namespace {

/// Some balls, cones, ellipsoids and a tube, blended and carved.
Field randomSculpture(std::mt19937_64& random) {
    std::uniform_real_distribution<double> unit(0, 1);
    const auto point = [&] { return Vec3(20 * unit(random), 20 * unit(random), 20 * unit(random)); };
    const auto radius = [&] { return 2 + 3 * unit(random); };
    Sculpture sculpture;
    for (int i = 0; i < 4; ++i) {
        sculpture.add(cone(point(), point(), radius(), radius()), 3 * unit(random));
        sculpture.add(ellipsoid(point(), Vec3(radius(), radius(), radius())), 1 + 3 * unit(random));
        sculpture.carve(ellipsoid(point(), Vec3(radius(), radius(), radius())), 1 + 2 * unit(random));
    }
    sculpture.add(tube({point(), point(), point()}, {2, 3, 2}), 2);
    return sculpture.field();
}

double worstQuality(const tss::TriangleMesh& mesh) {
    double worst = 1;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        worst = std::min(worst, quality(mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)));
    return worst;
}

} // namespace

TEST_CASE("any blend of solids becomes a closed mesh that faces outwards and lies on the surface") {
    const int seed = GENERATE(1, 2, 3, 4, 5, 6);
    INFO("seed " << seed);
    std::mt19937_64 random(seed);
    const Field field = randomSculpture(random);
    const tss::TriangleMesh raw = polygonize(field, 1);
    const tss::TriangleMesh mesh = remesh(raw, field, {.deviation = 0.1, .shortest = 0.8, .longest = 4});

    for (const tss::TriangleMesh* each : {&raw, &mesh}) {
        const tss::MeshAudit audit = tss::auditMesh(*each);
        CHECK(audit.watertight);
        CHECK(audit.signedVolume > 0);
        CHECK(audit.zeroAreaTriangles == 0);
    }
    CHECK(mesh.triangles.size() < raw.triangles.size() / 2);
    double meanOff = 0;
    for (const Vec3& v : mesh.vertices) meanOff += std::abs(field(v)) / mesh.vertices.size();
    CHECK(meanOff < 0.01);
}

TEST_CASE("an ellipsoid is met to the deviation asked for, by triangles near to equilateral") {
    const Field field = ellipsoid({1, 2, 3}, {20, 12, 7});
    const tss::TriangleMesh mesh = remesh(polygonize(field, 1.5), field, {.deviation = 0.1, .shortest = 0.5});
    CHECK(worstQuality(mesh) > 0.5);
    for (const tss::Tri& t : mesh.triangles)
        CHECK(std::abs(field((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3)) < 0.2);
    CHECK(tss::auditMesh(mesh).signedVolume == Approx(4 * M_PI / 3 * 20 * 12 * 7).epsilon(0.03));
}

TEST_CASE("the round cone's distance is exact") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    const Vec3 a(0, 0, 0), b(3, 1, -2);
    const double ra = 2, rb = 0.5;
    const Field field = cone(a, b, ra, rb);
    for (int i = 0; i < 200; ++i) {
        const Vec3 p = 8 * Vec3(unit(random), unit(random), unit(random));
        double nearest = 1e9; // the union of the balls along the axis
        for (int k = 0; k <= 4000; ++k) {
            const double t = k / 4000.;
            nearest = std::min(nearest, (p - (1 - t) * a - t * b).norm() - (1 - t) * ra - t * rb);
        }
        CHECK(field(p) == Approx(nearest).margin(1e-5));
    }
}

TEST_CASE("trimming leaves what is behind the plane, open along the cut and nowhere else") {
    const Field field = ellipsoid({0, 0, 0}, {10, 8, 6});
    const tss::TriangleMesh whole = remesh(polygonize(field, 1), field, {});
    const Vec3 point(2, 0, 0), outward = Vec3(1, 0.3, 0.2).normalized();
    const tss::TriangleMesh part = trim(whole, halfSpace(point, outward, {}));
    const tss::MeshAudit audit = tss::auditMesh(part);
    CHECK(audit.openEdges > 10);
    CHECK(audit.nonManifoldEdges == 0);
    CHECK(audit.misorientedEdges == 0);
    CHECK(audit.unusedVertices == 0);
    CHECK(worstQuality(part) > 0.05);
    int onCut = 0;
    for (const Vec3& v : part.vertices) {
        CHECK(outward.dot(v - point) < 1e-9);
        onCut += outward.dot(v - point) > -1e-9;
    }
    CHECK(onCut == audit.openEdges); // one loop: as many vertices as edges
}
