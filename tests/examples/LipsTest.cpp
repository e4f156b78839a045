#include "bake/motion/ClosestPointQuery.h"
#include "bake/play/Player.h"
#include "bake/scene/SceneFile.h"

#include <algorithm>
#include <catch2/catch.hpp>

using namespace tss;

namespace {

constexpr double reach = 4; // millimetres: how far the other lip is looked for

/// How far each vertex is above the part of the skin that it faces; `reach` where there is none.
std::vector<double> heights(const TriangleMesh& skin) {
    const ClosestPointQuery locator(skin);
    const std::vector<Vec3> normals = vertexNormals(skin);
    std::vector<double> result(skin.vertices.size(), reach);
    for (std::size_t v = 0; v < result.size(); ++v) {
        const NearestPoint near = locator.nearestFacing(skin.vertices[v], reach, -normals[v]);
        if (near.triangle < 0) continue;
        Vec3 normal = Vec3::Zero();
        for (int k = 0; k < 3; ++k) normal += near.weights[k] * normals[skin.triangles[near.triangle][k]];
        const Vec3 away = skin.vertices[v] - near.point;
        const double height = normal.normalized().dot(away);
        // Straight before it, and not beside its rim.
        if (std::abs(height) > 0.7 * away.norm()) result[v] = height;
    }
    return result;
}

struct Lips {
    double worst = 0, p95 = 0; ///< millimetres beyond the depth at rest
    std::size_t inside = 0;    ///< vertices
};

/// The jaw goes from rest, the mouth closed, to its limit; what goes into the other lip on the way.
Lips bitten(SceneModel& scene, bool selfContact) {
    constexpr int steps = 40;
    scene.skins[0].selfContact = selfContact;
    std::vector<std::string> warnings;
    Player player(scene, warnings);
    const std::vector<double> rest = heights(scene.bodies[scene.skins[0].body].mesh);
    std::vector<double> last = rest;
    std::vector<char> entered(rest.size(), 0); // from before the other lip: not a layer that lies behind it
    for (int step = 1; step <= steps; ++step) {
        player.step({scene.joints[0].dofs[0].lower * step / steps}, 0);
        const std::vector<double> now = heights(player.worldMeshes()[scene.skins[0].body]);
        for (std::size_t v = 0; v < now.size(); ++v) {
            entered[v] =
                rest[v] > -0.5 && now[v] < std::min(rest[v], 0.0) && (entered[v] || std::abs(last[v]) < 0.5);
            last[v] = now[v];
        }
    }
    std::vector<double> depths;
    for (std::size_t v = 0; v < last.size(); ++v)
        if (entered[v]) depths.push_back(std::min(rest[v], 0.0) - last[v]);
    std::sort(depths.begin(), depths.end());
    if (depths.empty()) return {};
    return {depths.back(), depths[depths.size() * 95 / 100], depths.size()};
}

} // namespace

TEST_CASE("the dog's lips keep out of each other when it bites") {
    SceneModel scene = loadScene(std::string(OSGTSS_SOURCE_DIR) + "/scenes/dog_lips_baked.tss");
    REQUIRE(scene.joints.size() == 1);
    const Lips without = bitten(scene, false), with = bitten(scene, true);
    WARN("lips in each other: " << without.inside << " vertices, 95 % within " << without.p95 << " mm, worst "
                                << without.worst << " mm; with contact of the skin with itself "
                                << with.inside << ", " << with.p95 << " mm, " << with.worst << " mm");
    CHECK(without.p95 > 0.5);
    CHECK(with.p95 < 0.5 * without.p95);
    CHECK(with.worst < 0.15 * without.worst);
    CHECK(2 * with.inside < without.inside + 30);
}
