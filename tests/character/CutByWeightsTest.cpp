#include "bake/character/CutByWeights.h"
#include "bake/geometry/MeshAudit.h"

#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// A square tube along x from 0 to 4, closed at both ends; each ring of four corners is a vertex row.
HeldMesh squareTube() {
    HeldMesh mesh;
    for (int x = 0; x <= 4; ++x)
        for (const auto& [y, z] : {std::pair(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
            mesh.points.emplace_back(x, y, z);
            mesh.weights.push_back({{x < 2 ? 0 : 1, 1.0f}});
        }
    const auto quad = [&](unsigned a, unsigned b, unsigned c, unsigned d) {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({a, c, d});
    };
    for (unsigned ring = 0; ring < 16; ring += 4)
        for (unsigned k = 0; k < 4; ++k)
            quad(ring + k, ring + 4 + k, ring + 4 + (k + 1) % 4, ring + (k + 1) % 4);
    quad(0, 1, 2, 3);
    quad(19, 18, 17, 16);
    return mesh;
}

} // namespace

TEST_CASE("a closed mesh of two bones is cut into two closed bodies, in their own frames") {
    const Holder holders[] = {{7, Eigen::Affine3d::Identity()},
                              {9, Eigen::Affine3d(Eigen::Translation3d(0, 0, -10))}};
    for (const bool mirrored : {false, true}) {
        HeldMesh mesh = squareTube();
        mesh.mirrored = mirrored;
        const auto parts = cutByWeights(holders, std::span(&mesh, 1));
        REQUIRE(parts.size() == 2);
        for (const auto& [body, part] : parts) {
            CHECK(auditMesh(part.surface).watertight);
            double volume = 0;
            for (std::size_t t = 0; t < part.surface.triangles.size(); ++t)
                volume += part.surface.corner(t, 0).dot(part.surface.areaNormal(t)) / 6;
            CHECK((volume > 0) == mirrored); // the tube is wound inwards
        }
        CHECK(bounds(parts.at(9).surface).max().z() == -9);
    }
}

TEST_CASE("what no bone holds is the loose holder's, and corners that are no numbers are counted there") {
    const Holder holders[] = {{0, Eigen::Affine3d::Identity()}, {1, Eigen::Affine3d::Identity()}};
    HeldMesh mesh = squareTube();
    for (auto& weights : mesh.weights) weights.clear();
    mesh.loose = 1;
    mesh.points[19].x() = std::numeric_limits<double>::quiet_NaN();
    const auto parts = cutByWeights(holders, std::span(&mesh, 1));
    REQUIRE(parts.size() == 1);
    CHECK(parts.at(1).dropped > 0);
    CHECK(parts.at(1).dropped + parts.at(1).surface.triangles.size() == mesh.triangles.size());
}
