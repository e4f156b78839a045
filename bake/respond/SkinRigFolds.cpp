#include "bake/motion/MuscleLocator.h"
#include "bake/respond/SkinContact.h"
#include "bake/respond/SkinRigParts.h"

#include <algorithm>

namespace tss::rig {
namespace {

constexpr double enterDepth =
    -0.25; ///< in radii: what is first met deeper than this was not met from outside

/// Activations and poses of one station: the skin at rest, at both ends of each muscle's range, and along the
/// swings of the bones.
struct Station {
    std::vector<double> activations;
    std::vector<Pose> poses;
};

std::vector<Station> stations(const SkinRig& rig) {
    const std::size_t muscles = rig.muscles.size();
    const Station rest{std::vector<double>(muscles, 0.0), std::vector<Pose>(muscles, Pose::Identity())};
    std::vector<Station> result{rest};
    for (std::size_t m = 0; m < muscles; ++m)
        for (const double end : {rig.muscles[m].drag.nodes.front(), rig.muscles[m].drag.nodes.back()}) {
            if (end == 0) continue;
            result.push_back(rest);
            result.back().activations[m] = end;
        }
    for (const BoneSwing& swing : rig.parameters.swings)
        for (const std::vector<Pose>& poses : swing) {
            result.push_back(rest);
            result.back().poses = poses;
        }
    return result;
}

} // namespace

void addFolds(SkinRig& rig, double radius, double reach) {
    rig.foldRadius = radius;
    rig.foldReach = reach;
    std::vector<std::vector<std::uint32_t>> met(rig.rest.size()); // triangles, one or a few a vertex
    TriangleMesh skin{rig.rest, rig.triangles};
    SkinScene scene;
    for (const Station& station : stations(rig)) {
        placeMuscles(rig, station.activations, station.poses, scene);
        skin.vertices = scene.predicted;
        const MuscleLocator locator(skin);
        for (std::uint32_t v = 0; v < rig.rest.size(); ++v) {
            if (!(rig.sheet.inverseMass[v] > 0)) continue;
            const Vec3 own = scene.turn.of(v) * rig.restNormals[v], &x = scene.predicted[v];
            const NearestPoint near = locator.nearestFacing(x, reach, -own);
            if (near.triangle < 0 || (skin.triangles[near.triangle].array() == static_cast<int>(v)).any())
                continue;
            const Vec3& corner = skin.corner(near.triangle, 0);
            const Vec3 normal = (skin.corner(near.triangle, 1) - corner)
                                    .cross(skin.corner(near.triangle, 2) - corner)
                                    .normalized();
            // Before it, and not through the layer that the vertex is a part of.
            if (normal.dot(x - near.point) < enterDepth * radius ||
                own.dot(near.point - x) < enterDepth * radius)
                continue;
            met[v].push_back(static_cast<std::uint32_t>(near.triangle));
        }
    }
    for (std::uint32_t v = 0; v < met.size(); ++v) {
        if (met[v].empty()) continue;
        std::sort(met[v].begin(), met[v].end());
        met[v].erase(std::unique(met[v].begin(), met[v].end()), met[v].end());
        SkinFold fold;
        fold.vertex = v;
        fold.first = static_cast<std::uint32_t>(rig.foldTriangles.size());
        rig.foldTriangles.insert(rig.foldTriangles.end(), met[v].begin(), met[v].end());
        fold.last = static_cast<std::uint32_t>(rig.foldTriangles.size());
        rig.folds.push_back(fold);
    }
}

} // namespace tss::rig
