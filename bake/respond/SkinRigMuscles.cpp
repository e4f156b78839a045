#include "bake/respond/SkinRigParts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tss::rig {
namespace {

constexpr double attachReach = 0.3; ///< share of the fibre around its moving end over which it is attached
constexpr int dragSteps = 8;        ///< nodes of a drag, without the first
constexpr int dragSweeps = 400;
constexpr double dragTolerance = 1e-7; ///< in sizes of the skin

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

void addDrag(SkinRig& rig, const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles) {
    const std::size_t count = rig.rest.size();
    const float tolerance = static_cast<float>(dragTolerance * rig.size);
    std::vector<SheetPlane> none;
    for (std::size_t m = 0; m < rig.muscles.size(); ++m) {
        SkinMuscle& muscle = rig.muscles[m];
        const Muscle& source = muscles[m]->muscle();
        muscle.drag.nodes = activationNodes(source.activationLower, source.activationUpper, dragSteps);
        SkinSolver solver(rig.sheet);
        std::vector<std::vector<Move>> solved;
        std::vector<float> most(count, 0);
        for (const double a : muscle.drag.nodes) {
            std::vector<Move> reference(count, Move::Zero());
            const TrackPlace place = locate(muscle.skin.nodes, a);
            for (std::size_t i = 0; i < muscle.carried.size(); ++i) {
                const SkinCarry& c = muscle.carried[i];
                const Vec3 d = trackPosition(muscle.skin, place, i) - rig.rest[c.vertex];
                reference[c.vertex].head<3>() += c.pull * d.cast<float>();
            }
            if (a == 0)
                solver.reset();
            else
                solver.solve(reference, none, dragSweeps, tolerance);
            solved.emplace_back(solver.displacements().begin(), solver.displacements().end());
            for (std::size_t v = 0; v < count; ++v) most[v] = std::max(most[v], solved.back()[v].norm());
        }
        for (std::uint32_t v = 0; v < count; ++v)
            if (most[v] > tolerance) muscle.drag.vertices.push_back(v);
        for (const auto& moves : solved)
            for (const std::uint32_t v : muscle.drag.vertices) muscle.drag.moves.push_back(moves[v]);
    }
}

void addPokes(SkinRig& rig, const MuscleDeformer& muscle, std::uint32_t index, double radius, double reach) {
    const SkinDrag& drag = rig.muscles[index].drag;
    const std::vector<Vec3>& rest = muscle.muscle().surface.vertices;
    std::vector<std::vector<int>> nearest(rest.size(), std::vector<int>(drag.nodes.size(), -1));
    std::vector<bool> needed(rest.size(), false);
    for (std::size_t n = 0; n < drag.nodes.size(); ++n) {
        TriangleMesh skin{rig.rest, rig.triangles};
        for (std::size_t k = 0; k < drag.vertices.size(); ++k)
            skin.vertices[drag.vertices[k]] +=
                drag.moves[n * drag.vertices.size() + k].head<3>().cast<double>();
        const TriangleMesh surface{muscle.vertices(drag.nodes[n]), muscle.muscle().surface.triangles};
        const std::vector<Vec3> normals = vertexNormals(surface);
        const MuscleLocator locator(skin);
        for (std::size_t v = 0; v < rest.size(); ++v) {
            const NearestPoint near = locator.nearestFacing(surface.vertices[v], reach, normals[v]);
            nearest[v][n] = near.triangle;
            if (near.triangle < 0) continue;
            for (int k = 0; k < 3; ++k)
                needed[v] = needed[v] || rig.sheet.inverseMass[rig.triangles[near.triangle][k]] > 0;
        }
    }
    for (std::uint32_t v = 0; v < rest.size(); ++v) {
        if (!needed[v]) continue;
        rig.pokes.push_back({index, v, static_cast<std::uint32_t>(rig.pokeTriangles.size()), radius});
        rig.pokeTriangles.insert(rig.pokeTriangles.end(), nearest[v].begin(), nearest[v].end());
    }
}

} // namespace tss::rig
