#include "bake/respond/SkinTurnLimit.h"

#include "SkinShapes.h"

#include <array>
#include <catch2/catch.hpp>

using namespace tss;

namespace {

/// The least area of a triangle after pushes, seen along its normal before, as a share of that before.
float leastArea(const SkinRig& rig, const SkinScene& scene) {
    float least = 1;
    for (const Tri& t : rig.triangles) {
        const auto area = [&](const std::vector<Move>& x) -> Eigen::Vector3f {
            return (x[t[1]] - x[t[0]]).head<3>().cross((x[t[2]] - x[t[0]]).head<3>());
        };
        const Eigen::Vector3f before = area(scene.carried);
        least = std::min(least, before.dot(area(scene.skin)) / before.squaredNorm());
    }
    return least;
}

/// Pushes a skin at two places beside its middle, by so many lengths of an edge. Returns the least area then,
/// and after the limit.
std::pair<float, float> pushed(const SkinRig& rig, const std::array<Eigen::Vector3f, 2>& ways, float edges) {
    SkinScene scene;
    placeBodies(rig, std::vector<double>{0}, std::vector<Pose>{Pose::Identity()}, {}, scene);
    SkinPushes pushes(rig.foundation);
    std::vector<char> blocks(rig.blocks(), 0);
    std::vector<SkinPlane> planes(2);
    const float edge = static_cast<float>(1 / 16.0 / rig.size), by = edges * edge;
    for (int k = 0; k < 2; ++k) {
        const Eigen::Vector2f at((k == 0 ? -2 : 2) * edge, 0);
        std::uint32_t nearest = 0;
        const auto off = [&](std::uint32_t v) { return (rig.places[v].head<2>() - at).norm(); };
        for (std::uint32_t v = 0; v < rig.places.size(); ++v)
            if (off(v) < off(nearest)) nearest = v;
        planes[k].vertices = 1;
        planes[k].vertex[0] = nearest;
        planes[k].weight[0] = 1;
        planes[k].normal = ways[k];
        planes[k].level = ways[k].dot(scene.carried[nearest].head<3>()) + by;
    }
    pushes.solve(planes, scene.carried, 60);
    pushes.apply(planes, scene.skin, blocks);
    const float before = leastArea(rig, scene);
    CHECK(SkinTurnLimit(rig).limit(scene, pushes, blocks));
    return {before, leastArea(rig, scene)};
}

} // namespace

TEST_CASE("pushes that would turn skin over are held until each triangle keeps a fiftieth of its area") {
    const auto [before, limited] =
        pushed(*skins::usual().rig(), {Eigen::Vector3f::UnitX(), -Eigen::Vector3f::UnitX()}, 5);
    CHECK(before < -0.2f);
    CHECK(limited > 0.02f);
    CHECK(limited < 0.05f); // and no smaller than need be
}

TEST_CASE("pushes turn no triangle of a ridged skin over, though it faces aside") {
    TriangleMesh ridged = skins::vaultedSheet(32, 1, 0.05, 0.3);
    for (std::size_t v = 0; v < ridged.vertices.size(); ++v)
        ridged.vertices[v][2] += v % 33 % 2 == 0 ? 0.05 : -0.05;
    const auto [before, limited] = pushed(*skins::couple(ridged, {skins::muscleBelow(0)}).rig(),
                                          {Eigen::Vector3f::UnitZ(), Eigen::Vector3f::UnitZ()}, 12);
    CHECK(before < 0);
    CHECK(limited > 0.01f);
}
