#include "bake/respond/SkinTurnLimit.h"

#include "SkinShapes.h"

#include <catch2/catch.hpp>

using namespace tss;

TEST_CASE("pushes that would turn skin over are held until each triangle keeps a fiftieth of its area") {
    const skins::Couple couple = skins::usual();
    const auto rig = couple.rig();
    SkinScene scene;
    placeBodies(*rig, std::vector<double>{0}, std::vector<Pose>{Pose::Identity()}, {}, scene);
    SkinPushes pushes(rig->foundation);
    std::vector<char> blocks(rig->blocks(), 0);
    // Along the skin at two places, towards each other, by five times the length of an edge.
    std::vector<SkinPlane> planes(2);
    const float edge = static_cast<float>(1 / 16.0 / rig->size), by = 5 * edge;
    for (int k = 0; k < 2; ++k) {
        const Eigen::Vector3f at((k == 0 ? -2 : 2) * edge, 0, rig->places[0][2]);
        std::uint32_t nearest = 0;
        const auto off = [&](std::uint32_t v) { return (rig->places[v].head<2>() - at.head<2>()).norm(); };
        for (std::uint32_t v = 0; v < rig->places.size(); ++v)
            if (off(v) < off(nearest)) nearest = v;
        planes[k].vertices = 1;
        planes[k].vertex[0] = nearest;
        planes[k].weight[0] = 1;
        planes[k].normal = (k == 0 ? 1 : -1) * Eigen::Vector3f::UnitX();
        planes[k].level = planes[k].normal.dot(scene.carried[nearest].head<3>()) + by;
    }
    pushes.solve(planes, scene.carried, by, 60);
    pushes.apply(planes, scene.skin, blocks);
    const auto leastArea = [&] {
        float least = 1;
        for (const Tri& t : rig->triangles) {
            const auto area = [&](const std::vector<Move>& x) -> Eigen::Vector3f {
                return (x[t[1]] - x[t[0]]).head<3>().cross((x[t[2]] - x[t[0]]).head<3>());
            };
            const Eigen::Vector3f before = area(scene.carried);
            least = std::min(least, before.dot(area(scene.skin)) / before.squaredNorm());
        }
        return least;
    };
    CHECK(leastArea() < -0.2f);
    CHECK(SkinTurnLimit(*rig).limit(scene, pushes, blocks));
    CHECK(leastArea() > 0.02f);
    CHECK(leastArea() < 0.05f); // and no smaller than need be
}
