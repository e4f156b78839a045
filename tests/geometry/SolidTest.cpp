#include "bake/geometry/Solid.h"

#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/TriangleDistance.h"
#include "tests/geometry/TestMeshes.h"

#include <array>
#include <catch2/catch.hpp>
#include <numbers>

using namespace tss;
using namespace tss::test;

TEST_CASE("fans close what is open") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
    const Solid opened(mesh), whole(boxMesh({0, 0, 0}, {1, 1, 1}));
    CHECK(opened.boundary().triangleCount() == mesh.triangles.size() + 4);
    CHECK(opened.boundary().windingNumber({0.5, 0.5, 0.9}) == Approx(1));
    CHECK(whole.boundary().triangleCount() == 12);
}

TEST_CASE("an opened box is solid up to its opening") {
    TriangleMesh mesh = boxMesh({-1, -1, -1}, {1, 1, 1});
    mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
    const Solid solid(mesh);
    CHECK(solid.inside({0, 0, 0.99}));
    CHECK_FALSE(solid.inside({0, 0, 1.01}));
    CHECK(solid.boundary().distance({0, 0, 0.9}) == Approx(0.1));
    CHECK_FALSE(solid.assumptions().empty());
}

TEST_CASE("the winding number about any heap of triangles and its fans is an integer") {
    const std::uint64_t seed = GENERATE(1u, 2u, 3u);
    CAPTURE(seed);
    std::mt19937_64 random(seed);
    TriangleMesh mesh = lumpyMesh(random, 3, 0.3);
    // Triangles lost, turned over and repeated, edges of three and more triangles.
    for (int i = 0; i < 60; ++i) {
        Tri& t = mesh.triangles[random() % mesh.triangles.size()];
        if (i % 3 == 0) std::swap(t[0], t[1]);
        if (i % 3 == 1) t = Tri(t[0], t[1], static_cast<int>(random() % mesh.vertices.size()));
        if (i % 3 == 2) mesh.triangles.pop_back();
    }
    const Solid solid(mesh);
    for (int i = 0; i < 200; ++i) {
        const double w = solid.boundary().windingNumber(uniformPoint(random, 1.3));
        CHECK(std::abs(w - std::round(w)) < 0.2);
    }
}

TEST_CASE("the winding number of a closed mesh is that of all its solid angles, also where a ray meets a "
          "corner or edge") {
    std::mt19937_64 random(11);
    TriangleMesh mesh = lumpyMesh(random, 3, 0.3);
    append(mesh, turnedInsideOut(transformed(mesh, Eigen::Affine3d(Eigen::Translation3d(0.7, 0.2, 0)))));
    append(mesh, boxMesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
    append(mesh, boxMesh({-0.5, -0.5, -0.5}, {1.5, 1.5, 1.5}));
    const Solid solid(mesh);
    REQUIRE_FALSE(solid.open());
    std::vector<Vec3> points;
    for (int i = 0; i < 2000; ++i) points.push_back(uniformPoint(random, 1.5));
    for (int i = 0; i < 2000; ++i) {
        const Corners c = mesh.corners(random() % mesh.triangles.size());
        const Vec3 on = i % 2 == 0 ? c[0] : Vec3(0.25 * c[0] + 0.75 * c[1]);
        const Vec3 along = i % 4 < 2 ? Vec3(1, 0.6180339887498949, 0.4142135623730951)
                                     : Vec3(1, -0.3027756377319946, 0.7320508075688772);
        points.push_back(on - std::exp2(-double(i % 20)) * along);
    }
    int in = 0;
    for (const Vec3& p : points) {
        if (solid.boundary().distance(p) < 1e-9) continue;
        double sum = 0;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const Corners c = mesh.corners(t);
            sum += solidAngle(p, c[0], c[1], c[2]);
        }
        const double number = std::round(sum / (4 * std::numbers::pi));
        in += number != 0;
        CHECK(solid.boundary().windingNumber(p) == Approx(number).margin(0.2));
        CHECK(solid.inside(p) == (number != 0));
    }
    CHECK(in > 500);
}

TEST_CASE("seams and T-junctions are no openings, and cracks are closed along them") {
    std::mt19937_64 random(4);
    const TriangleMesh whole = lumpyMesh(random, 2, 0.3);
    TriangleMesh soup;
    for (const Tri& t : whole.triangles) {
        const auto at = static_cast<int>(soup.vertices.size());
        for (int k = 0; k < 3; ++k) soup.vertices.push_back(whole.vertices[t[k]]);
        soup.triangles.emplace_back(at, at + 1, at + 2);
    }
    TriangleMesh cracked = soup;
    for (Vec3& v : cracked.vertices) v += uniformPoint(random, 1e-4);
    TriangleMesh junctions = whole;
    for (std::size_t i = 0; i < whole.triangles.size(); i += 3) {
        const Tri t = junctions.triangles[i];
        const auto middle = static_cast<int>(junctions.vertices.size());
        junctions.vertices.emplace_back(0.5 * (junctions.vertices[t[0]] + junctions.vertices[t[1]]));
        junctions.triangles[i] = Tri(t[0], middle, t[2]);
        junctions.triangles.emplace_back(middle, t[1], t[2]);
    }
    const Solid solid(whole);
    const std::array<TriangleMesh, 3> meshes{soup, cracked, junctions};
    for (const TriangleMesh& mesh : meshes) {
        CHECK_FALSE(auditMesh(mesh).watertight);
        const Solid seamed(mesh);
        CHECK(seamed.open() == (&mesh == &meshes[1]));
        CHECK(seamed.assumptions().starts_with(seamed.open() ? "cracks, up to 0.000" : ""));
        CHECK(seamed.assumptions().empty() != seamed.open());
        for (int i = 0; i < 200; ++i) {
            const Vec3 p = uniformPoint(random, 1.3);
            if (solid.boundary().distance(p) > 1e-3) CHECK(seamed.inside(p) == solid.inside(p));
        }
    }
    // A triangle that is not there is an opening, among seams too.
    soup.triangles.pop_back();
    CHECK(Solid(soup).open());
}

TEST_CASE("a hole with a rim of short edges is an opening, however fine the rim") {
    // A plate from -1 to 1 with a round hole of many edges, in a box of few long ones that share no vertices.
    constexpr int around = 200;
    TriangleMesh mesh = boxMesh({-1, -1, -1}, {1, 1, 1});
    std::erase_if(mesh.triangles, [&](const Tri& t) {
        return std::ranges::all_of(t, [&](int v) { return mesh.vertices[v].z() == 1; });
    });
    for (int k = 0; k < around; ++k) {
        const auto onRing = [](double radius, int k) {
            const double angle = 2 * std::numbers::pi * k / around;
            return Vec3(radius * std::cos(angle), radius * std::sin(angle), 1);
        };
        const auto onRim = [&](int k) {
            const Vec3 p = onRing(1, k);
            return Vec3(p.x() / p.head<2>().lpNorm<Eigen::Infinity>(),
                        p.y() / p.head<2>().lpNorm<Eigen::Infinity>(), 1);
        };
        const auto at = static_cast<int>(mesh.vertices.size());
        for (const Vec3& p : {onRing(0.1, k), onRim(k), onRim(k + 1), onRing(0.1, k + 1)})
            mesh.vertices.push_back(p);
        mesh.triangles.emplace_back(at, at + 1, at + 2);
        mesh.triangles.emplace_back(at, at + 2, at + 3);
    }
    const Solid solid(mesh);
    CHECK(solid.open());
    CHECK(solid.inside({0, 0, 0.99}));
    CHECK_FALSE(solid.inside({0, 0, 1.01}));
    CHECK(solid.boundary().distance({0, 0, 0.95}) == Approx(0.05)); // the fan over the hole
    CHECK(solid.protrusion({0, 0, 0.95}, 0.09) == Approx(0.04));
}

TEST_CASE("a crack is closed where it is, and counts as what may be gone through") {
    TriangleMesh mesh = boxMesh({-50, -50, -50}, {50, 50, 50});
    TriangleMesh lid;
    for (const Tri& t : mesh.triangles)
        if (std::ranges::all_of(t, [&](int v) { return mesh.vertices[v].z() == 50; })) {
            for (const int v : t) lid.vertices.push_back(mesh.vertices[v] + Vec3(0, 0, 0.9));
            const int at = static_cast<int>(lid.vertices.size());
            lid.triangles.emplace_back(at - 3, at - 2, at - 1);
        }
    std::erase_if(mesh.triangles, [&](const Tri& t) {
        return std::ranges::all_of(t, [&](int v) { return mesh.vertices[v].z() == 50; });
    });
    const auto first = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), lid.vertices.begin(), lid.vertices.end());
    for (const Tri& t : lid.triangles) mesh.triangles.emplace_back(t[0] + first, t[1] + first, t[2] + first);
    const Solid solid(mesh);
    CHECK(solid.open());
    CHECK(solid.assumptions().find("up to 0.9 scene units") != std::string::npos);
    CHECK(solid.inside({0, 0, 50.8}));
    CHECK_FALSE(solid.inside({0, 0, 51}));
    CHECK(solid.inside({0, 49.9, 50.4}));
    CHECK_FALSE(solid.inside({0, 50.1, 50.4}));
    CHECK(solid.boundary().distance({0, 49.9, 50.45}) ==
          Approx(0.1).epsilon(1e-3)); // the strip over the crack
}

TEST_CASE("a hollow mesh is its surface alone") {
    TriangleMesh mesh = boxMesh({-1, -1, -1}, {1, 1, 1});
    mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
    const Solid solid(mesh, Interior::Hollow);
    CHECK(solid.open());
    CHECK_FALSE(solid.inside({0, 0, 0}));
    CHECK(solid.boundary().distance({0, 0, 1.5}) > 1); // no fan over the opening
    CHECK(solid.protrusion({0, 0, 0}, 0.5) == Approx(1.5));
    CHECK(solid.protrusion({0, 0, -1}, 0.5) == Approx(0.5));
    CHECK(solid.assumptions().find("hollow") != std::string::npos);
}

TEST_CASE("a cavity is outside, an overlap of two components inside") {
    TriangleMesh hollow = boxMesh({0, 0, 0}, {4, 4, 4});
    append(hollow, turnedInsideOut(boxMesh({1, 1, 1}, {3, 3, 3})));
    CHECK(Solid(hollow).inside({0.5, 2, 2}));
    CHECK_FALSE(Solid(hollow).inside({2, 2, 2}));
    TriangleMesh overlapping = boxMesh({0, 0, 0}, {2, 2, 2});
    append(overlapping, boxMesh({1, 0, 0}, {3, 2, 2}));
    CHECK(Solid(overlapping).inside({1.5, 1, 1}));
}

TEST_CASE("a ball inside does not protrude, one outside does with all of it") {
    const Solid solid(boxMesh({0, 0, 0}, {1, 1, 1}));
    CHECK(solid.protrusion({0.5, 0.5, 0.5}, 0.5) == 0);
    CHECK(solid.protrusion({0.5, 0.5, 0.5}, 0.7) == Approx(0.2));
    CHECK(solid.protrusion({0.5, 0.5, 2}, 0.25) == Approx(1.25));
    CHECK(solid.protrusion({0.5, 0.5, 1}, 0.25) == Approx(0.25));
}

TEST_CASE("a wire on a box is surface: near, and neither an opening nor an inside") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    const auto wire = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        const int first = static_cast<int>(mesh.vertices.size());
        for (const Vec3& v : {a, b, c}) mesh.vertices.push_back(v);
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    };
    wire({1, 0.5, 0.5}, {5, 0.5, 0.5}, {5, 0.5, 0.5});
    wire({0.5, 0.5, 1}, {0.7, 0.8, 3.1}, {0.6, 0.65, 2.05}); // three places, in a line but for rounding
    wire({-3, -3, -3}, {-3, -3, -3}, {-3, -3, -3});
    REQUIRE(auditMesh(mesh).zeroAreaTriangles == 3);
    const TriangleMesh clean = cleaned(mesh);
    REQUIRE(clean.triangles.size() == mesh.triangles.size());
    const Solid solid(clean);
    CHECK_FALSE(solid.open());
    CHECK(solid.assumptions().empty());
    CHECK(solid.boundary().distance({4, 0.5, 2.5}) == Approx(2));
    CHECK(solid.boundary().distance({-3, -3, -5}) == Approx(2));
    CHECK(solid.inside({0.5, 0.5, 0.5}));
    CHECK_FALSE(solid.inside({1.5, 0.5, 0.5})); // on the wire
    std::mt19937_64 random(1);
    for (int i = 0; i < 2000; ++i) {
        const double t = uniform(random, 0.01, 1);
        const Vec3 on = Vec3(0.5, 0.5, 1) + t * Vec3(0.2, 0.3, 2.1),
                   near = on + 1e-16 * uniformPoint(random, 1);
        CHECK(std::abs(solid.boundary().windingNumber(near)) < 0.01);
    }
}

TEST_CASE("in a mesh given for both of its sides nothing is inside, and it is said so") {
    TriangleMesh mesh = boxMesh({0, 0, 0}, {1, 1, 1});
    const TriangleMesh other = turnedInsideOut(mesh);
    mesh.triangles.insert(mesh.triangles.end(), other.triangles.begin(), other.triangles.end());
    const Solid solid(mesh);
    CHECK_FALSE(solid.open());
    CHECK_FALSE(solid.inside(Vec3::Constant(0.5)));
    CHECK(solid.assumptions().starts_with("12 triangles are given a second time turned over"));
}
