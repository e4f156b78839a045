#include "bake/geometry/PartSet.h"
#include "tests/geometry/TestMeshes.h"

#include <catch2/catch.hpp>

using namespace tss;
using namespace tss::test;

TEST_CASE("halves of a part become the whole again, and parts in others vanish") {
    PartSet set;
    CHECK(set.empty());
    for (const std::uint32_t cuts : {4u, 5u, 6u, 14u, 15u}) set.insert({3, cuts});
    set.insert({1, 2});
    set.insert({1, 9}); // a part of triangle 1's first half's first half's second
    CHECK(set.merged() == std::vector<SurfacePart>{{1, 2}, {3, 1}});
    CHECK(set.contains({1, 2}));
    CHECK(set.contains({1, 4}));
    CHECK_FALSE(set.contains({1, 1}));
    CHECK_FALSE(set.contains({1, 3}));
    CHECK(set.reaches({1, 1}));
    CHECK_FALSE(set.reaches({1, 3}));
    CHECK_FALSE(set.reaches({2, 1}));
}

TEST_CASE("of edges that are equal but for rounding the one is cut that the file format says") {
    // (x, y, z) and (z, y, x) are equally long; summed as (x^2 + y^2) + z^2 the first comes out longer,
    // summed from the right the second does.
    const double x = 0.017f, y = 0.724f, z = 0.115f;
    const Vec3 a(0, 0, 0), b(x, y, z), c(z, y, x);
    const Vec3 middle = 0.5 * (a + b);
    CHECK(halves(Corners{a, b, c}) == std::array{Corners{a, middle, c}, Corners{middle, b, c}});
}

TEST_CASE("merged parts are the same surface") {
    std::mt19937_64 random(3);
    const TriangleMesh mesh = lumpyMesh(random, 1, 0.3);
    for (int round = 0; round < 20; ++round) {
        // Leaves of one depth: their area is that of what they are merged to, and all are contained.
        PartSet set;
        std::vector<SurfacePart> leaves;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            for (std::uint32_t cuts = 8; cuts < 16; ++cuts)
                if (random() % 4) leaves.push_back({t, cuts});
        for (const SurfacePart& leaf : leaves) set.insert(leaf);
        const std::vector<SurfacePart> merged = set.merged();
        CHECK(merged.size() < leaves.size());
        CHECK(area(mesh, merged) == Approx(area(mesh, leaves)));
        CHECK(std::is_sorted(merged.begin(), merged.end()));
        for (const SurfacePart& leaf : leaves) CHECK(set.contains(leaf));
        CHECK(meshOf(mesh, merged).triangles.size() == merged.size());
    }
}

TEST_CASE("parts are found again in a mesh with other triangles before them, turned or given twice") {
    std::mt19937_64 random(5);
    const TriangleMesh mesh = lumpyMesh(random, 1, 0.3);
    TriangleMesh other = mesh;
    for (Tri& t : other.triangles) t = Tri(t[1], t[2], t[0]);
    other.triangles.insert(other.triangles.begin(), Tri(0, 0, 1));
    other.triangles.push_back(mesh.triangles[4]);
    const std::vector<SurfacePart> parts{{2, 1}, {4, 13}, {7, 6}};
    const std::vector<SurfacePart> found = partsOf(other, mesh, parts);
    REQUIRE(found.size() == 4); // triangle 4 is there twice
    CHECK(found[0].triangle == 3);
    CHECK(found[1].triangle == 5);
    CHECK(found[2].triangle == 8);
    CHECK(found[3].triangle + 1 == other.triangles.size());
    CHECK(area(other, found) == Approx(area(mesh, parts) + area(mesh, {{4, 13}})));
    const auto middle = [](const Corners& c) { return Vec3((c[0] + c[1] + c[2]) / 3); };
    CHECK((middle(corners(other, found[1])) - middle(corners(mesh, {4, 13}))).norm() < 1e-12);
    CHECK((middle(corners(other, found[3])) - middle(corners(mesh, {4, 13}))).norm() < 1e-12);
}
