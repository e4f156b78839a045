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

/// What two pushes do to a skin.
struct Pushed {
    float before, limited; ///< the least area, of that carried, before the limit and after it
    float left;            ///< share of the pushes that the limit leaves
};

/// Pushes a skin at two places beside its middle, by so many lengths of an edge.
Pushed pushed(const SkinRig& rig, const std::array<Eigen::Vector3f, 2>& ways, float edges) {
    SkinScene scene;
    placeBodies(rig, std::vector<double>{0}, std::vector<Pose>{Pose::Identity()}, {}, scene);
    SkinPushes pushes(rig);
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
    pushes.apply(planes, scene);
    const auto moved = [&] {
        float sum = 0;
        for (const SkinPlane& plane : planes)
            sum += plane.normal.dot((scene.skin[plane.vertex[0]] - scene.carried[plane.vertex[0]]).head<3>());
        return sum;
    };
    const float before = leastArea(rig, scene), whole = moved();
    CHECK(SkinTurnLimit(rig).limit(scene, pushes));
    return {before, leastArea(rig, scene), moved() / whole};
}

} // namespace

TEST_CASE("pushes that would turn skin over are held until each triangle keeps a fiftieth of its area") {
    for (const float edges : {5.0f, 12.0f}) {
        const Pushed skin =
            pushed(*skins::usual().rig(), {Eigen::Vector3f::UnitX(), -Eigen::Vector3f::UnitX()}, edges);
        CHECK(skin.before < -0.2f);
        CHECK(skin.limited > 0.02f);
        CHECK(skin.limited < 0.05f); // and the pushes no smaller than need be
    }
}

TEST_CASE(
    "skin that two pushes bring together takes its surroundings along, and more of the pushes is left") {
    const Eigen::Vector3f up(1, 0, 1), other(-1, 0, 1);
    const Pushed skin = pushed(*skins::usual().rig(), {up.normalized(), other.normalized()}, 25);
    CHECK(skin.before < -0.2f);
    CHECK(skin.limited > 0.02f);
    CHECK(skin.left > 0.25f); // by making pushes smaller alone 0.03, after 16 rounds of gathering 0.17
}

TEST_CASE("pushes turn no triangle of a ridged skin over, though it faces aside") {
    TriangleMesh ridged = skins::vaultedSheet(32, 1, 0.05, 0.3);
    for (std::size_t v = 0; v < ridged.vertices.size(); ++v)
        ridged.vertices[v][2] += v % 33 % 2 == 0 ? 0.05 : -0.05;
    const Pushed skin = pushed(*skins::couple(ridged, {skins::muscleBelow(0)}).rig(),
                               {Eigen::Vector3f::UnitZ(), Eigen::Vector3f::UnitZ()}, 12);
    CHECK(skin.before < 0);
    CHECK(skin.limited > 0.01f);
}
