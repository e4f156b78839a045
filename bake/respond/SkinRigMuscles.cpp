#include "bake/respond/SkinRigParts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss::rig {
namespace {

constexpr double attachReach = 0.3; ///< share of the fibre around its moving end over which it is attached

/// 1 at 0, 0 from 1 on, smooth.
double falloff(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return 1 - t * t * (3 - 2 * t);
}

} // namespace

std::vector<Closeness> closeness(const TriangleMesh& skin, const std::vector<Vec3>& normals,
                                 const MuscleDeformer& muscle, double reach) {
    Eigen::AlignedBox3d box = bounds(muscle.muscle().surface);
    box.min().array() -= reach;
    box.max().array() += reach;
    const double movingEnd = muscle.muscle().anchor < 0.5 ? 1 : 0;
    std::vector<Closeness> result;
    for (std::uint32_t v = 0; v < skin.vertices.size(); ++v) {
        if (!box.contains(skin.vertices[v])) continue;
        Closeness c{v, muscle.bind(skin.vertices[v]), 0, 0};
        c.close =
            falloff((c.point.height / reach - 0.25) / 0.75) * std::max(0.0, c.point.normal.dot(normals[v]));
        if (!(c.close > 0)) continue;
        c.attach = c.close * falloff(std::abs(c.point.s - movingEnd) / attachReach);
        result.push_back(c);
    }
    return result;
}

void addBehind(SkinMuscle& muscle, const TriangleMesh& surface, const SphereSet& spheres) {
    std::vector<std::vector<std::uint32_t>> lists(spheres.size());
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t) {
        const Vec3 &a = surface.corner(t, 0), &b = surface.corner(t, 1), &c = surface.corner(t, 2);
        double nearest = std::numeric_limits<double>::infinity();
        std::size_t owner = spheres.size();
        bool inside = false;
        for (std::size_t s = 0; s < spheres.size(); ++s) {
            const Vec3 w = nearestOnTriangle(spheres[s].centre, a, b, c);
            const double gap =
                (spheres[s].centre - w[0] * a - w[1] * b - w[2] * c).norm() - spheres[s].radius;
            if (gap <= 0.1 * spheres[s].radius) {
                lists[s].push_back(t);
                inside = true;
            }
            if (gap < nearest) {
                nearest = gap;
                owner = s;
            }
        }
        if (!inside && owner < spheres.size()) lists[owner].push_back(t);
    }
    muscle.behindStart.assign(1, 0);
    for (const auto& list : lists) {
        muscle.behind.insert(muscle.behind.end(), list.begin(), list.end());
        muscle.behindStart.push_back(static_cast<std::uint32_t>(muscle.behind.size()));
    }
}

void addPokes(SkinRig& rig, const MuscleDeformer& muscle, std::uint32_t index, double radius, double reach) {
    const TriangleMesh touched{rig.rest, rig.triangles};
    const MuscleLocator locator(touched);
    std::vector<std::vector<std::uint32_t>> around(rig.rest.size());
    for (std::uint32_t t = 0; t < rig.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) around[rig.triangles[t][k]].push_back(t);

    const TriangleMesh& surface = muscle.muscle().surface;
    const std::vector<Vec3> normals = vertexNormals(surface);
    for (std::uint32_t v = 0; v < surface.vertices.size(); ++v) {
        const NearestPoint near = locator.nearestFacing(surface.vertices[v], reach, normals[v]);
        if (near.triangle < 0) continue;
        std::vector<std::uint32_t> candidates;
        bool moves = false;
        for (int k = 0; k < 3; ++k) {
            const int corner = rig.triangles[near.triangle][k];
            moves = moves || rig.inverseMass[corner] > 0;
            candidates.insert(candidates.end(), around[corner].begin(), around[corner].end());
        }
        if (!moves) continue;
        std::sort(candidates.begin(), candidates.end());
        candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
        const auto first = static_cast<std::uint32_t>(rig.pokeTriangles.size());
        rig.pokeTriangles.insert(rig.pokeTriangles.end(), candidates.begin(), candidates.end());
        rig.pokes.push_back({index, v, first, static_cast<std::uint32_t>(rig.pokeTriangles.size()), radius});
    }
}

} // namespace tss::rig
