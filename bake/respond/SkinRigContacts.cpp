#include "bake/respond/SkinRigParts.h"
#include "bake/respond/SkinWalk.h"

#include <deque>
#include <functional>
#include <limits>

namespace tss::rig {
namespace {

constexpr int walkSteps = 40; ///< from one node to the next the way may be long
constexpr double enterDepth =
    -0.25; ///< in radii: what is first met deeper than this was not met from outside

/// Skin and muscle at one node of the muscle's drag.
struct Station {
    TriangleMesh skin, surface;
    std::vector<Vec3> surfaceNormals;
};

std::vector<Station> stations(const SkinRig& rig, const SkinMuscle& muscle) {
    std::vector<Station> result;
    const SkinDrag& drag = muscle.drag;
    for (std::size_t n = 0; n < drag.nodes.size(); ++n) {
        Station s{{rig.rest, rig.triangles}, {{}, muscle.triangles}, {}};
        for (std::size_t k = 0; k < drag.vertices.size(); ++k)
            s.skin.vertices[drag.vertices[k]] +=
                drag.moves[n * drag.vertices.size() + k].head<3>().cast<double>();
        const TrackPlace place = locate(muscle.surface.nodes, drag.nodes[n]);
        for (std::size_t v = 0; v < muscle.surface.points; ++v)
            s.surface.vertices.push_back(trackPosition(muscle.surface, place, v));
        s.surfaceNormals = vertexNormals(s.surface);
        result.push_back(std::move(s));
    }
    return result;
}

/// Nearest points on the part of a surface that comes into reach of some points; knows no others.
class PartLocator {
public:
    PartLocator(const TriangleMesh& whole, Eigen::AlignedBox3d box, double reach)
        : part_{whole.vertices, {}}, of_(trianglesNear(whole, box, reach, part_)), locator_(part_) {}
    PartLocator(const PartLocator&) = delete;

    NearestPoint nearestFacing(const Vec3& x, double range, const Vec3& facing) const {
        NearestPoint near = locator_.nearestFacing(x, range, facing);
        if (near.triangle >= 0) near.triangle = of_[near.triangle];
        return near;
    }

private:
    static std::vector<int> trianglesNear(const TriangleMesh& whole, Eigen::AlignedBox3d box, double reach,
                                          TriangleMesh& part) {
        std::vector<int> of;
        box.min().array() -= reach;
        box.max().array() += reach;
        for (std::size_t t = 0; t < whole.triangles.size(); ++t) {
            Eigen::AlignedBox3d corners;
            for (int k = 0; k < 3; ++k) corners.extend(whole.corner(t, k));
            if (!box.intersects(corners)) continue;
            of.push_back(static_cast<int>(t));
            part.triangles.push_back(whole.triangles[t]);
        }
        return of;
    }

    TriangleMesh part_;
    std::vector<int> of_; ///< #triangles of the part, in the whole
    MuscleLocator locator_;
};

/// One point at each station against a surface that moves too: found where it comes into reach from outside,
/// then followed over the surface. triangles: one a station, -1 where there is none.
struct Follower {
    double reach = 0, radius = 0;
    bool pointOutside = true; ///< the point belongs in front of the surface; a poke belongs behind it
    const std::vector<Tri>& across;
    std::function<const TriangleMesh&(std::size_t)> surface;
    std::function<Vec3(std::size_t)> point, facing;
    std::function<NearestPoint(std::size_t, const Vec3&, const Vec3&)> find;

    int next(std::size_t station, int before, bool atRest) const {
        const TriangleMesh& mesh = surface(station);
        const Vec3 x = point(station);
        if (before >= 0) {
            const auto place = [&](int v) -> const Vec3& { return mesh.vertices[v]; };
            return walkDownhill(x, before, mesh.triangles, across, place, walkSteps).triangle;
        }
        const NearestPoint near = find(station, x, facing(station));
        if (near.triangle < 0 || atRest) return near.triangle;
        const Vec3& a = mesh.corner(near.triangle, 0);
        const Vec3 normal =
            (mesh.corner(near.triangle, 1) - a).cross(mesh.corner(near.triangle, 2) - a).normalized();
        const double height = (pointOutside ? 1 : -1) * normal.dot(x - near.point);
        return height >= enterDepth * radius ? near.triangle : -1;
    }

    void follow(std::size_t count, std::size_t rest, int* triangles) const {
        triangles[rest] = next(rest, -1, true);
        for (std::size_t n = rest + 1; n < count; ++n) triangles[n] = next(n, triangles[n - 1], false);
        for (std::size_t n = rest; n-- > 0;) triangles[n] = next(n, triangles[n + 1], false);
    }
};

std::size_t restNode(const SkinDrag& drag) {
    std::size_t best = 0;
    for (std::size_t n = 0; n < drag.nodes.size(); ++n)
        if (std::abs(drag.nodes[n]) < std::abs(drag.nodes[best])) best = n;
    return best;
}

} // namespace

void addRowTriangles(SkinRig& rig, std::uint32_t index, double reach) {
    SkinMuscle& muscle = rig.muscles[index];
    muscle.across = trianglesAcross(muscle.triangles);
    const std::vector<Station> at = stations(rig, muscle);
    std::vector<MuscleLocator> locators;
    locators.reserve(at.size());
    for (const Station& s : at) locators.emplace_back(s.surface);
    muscle.behind.clear();
    const std::size_t restAt = restNode(muscle.drag);
    const TrackPlace restPlace = locate(muscle.spheres.nodes, muscle.drag.nodes[restAt]);
    for (std::size_t s = 0; s < muscle.spheres.points; ++s)
        muscle.behind.push_back(
            locators[restAt]
                .nearest(trackPosition(muscle.spheres, restPlace, s), std::numeric_limits<double>::infinity())
                .triangle);
    for (SkinRow& row : rig.rows) {
        if (row.muscle != index) continue;
        row.triangles = static_cast<std::uint32_t>(rig.rowTriangles.size());
        rig.rowTriangles.resize(rig.rowTriangles.size() + at.size(), -1);
        const Follower follower{
            reach,
            row.radius,
            true,
            muscle.across,
            [&](std::size_t n) -> const TriangleMesh& { return at[n].surface; },
            [&](std::size_t n) { return at[n].skin.vertices[row.vertex]; },
            [&](std::size_t) { return rig.restNormals[row.vertex]; },
            [&](std::size_t n, const Vec3& x, const Vec3&) { return locators[n].nearest(x, reach); }};
        const std::size_t rest = restNode(muscle.drag);
        follower.follow(at.size(), rest, &rig.rowTriangles[row.triangles]);
        for (std::size_t n = 0; n < at.size(); ++n) row.met |= rig.rowTriangles[row.triangles + n] >= 0;
        row.facing = rig.restNormals[row.vertex];
        if (const int t = rig.rowTriangles[row.triangles + rest]; t >= 0) {
            const TriangleMesh& mesh = at[rest].surface;
            const Vec3 w = nearestOnTriangle(rig.rest[row.vertex], mesh.corner(t, 0), mesh.corner(t, 1),
                                             mesh.corner(t, 2));
            row.restTriangle = t;
            row.restWeights = w;
            row.facing.setZero();
            for (int k = 0; k < 3; ++k) row.facing += w[k] * at[rest].surfaceNormals[mesh.triangles[t][k]];
            row.facing.normalize();
            Vec3 hit = Vec3::Zero();
            for (int k = 0; k < 3; ++k) hit += w[k] * mesh.corner(t, k);
            row.restHeight = row.facing.dot(rig.rest[row.vertex] - hit);
        }
    }
}

void addPokes(SkinRig& rig, std::uint32_t index, double radius, double reach) {
    const SkinMuscle& muscle = rig.muscles[index];
    const std::vector<Station> at = stations(rig, muscle);
    std::deque<PartLocator> locators;
    for (const Station& s : at) locators.emplace_back(s.skin, bounds(s.surface), reach);
    std::vector<int> triangles(at.size());
    for (std::uint32_t v = 0; v < muscle.rest.size(); ++v) {
        const Follower follower{reach,
                                radius,
                                false,
                                rig.across,
                                [&](std::size_t n) -> const TriangleMesh& { return at[n].skin; },
                                [&](std::size_t n) { return at[n].surface.vertices[v]; },
                                [&](std::size_t n) { return at[n].surfaceNormals[v]; },
                                [&](std::size_t n, const Vec3& x, const Vec3& f) {
                                    return locators[n].nearestFacing(x, reach, f);
                                }};
        follower.follow(at.size(), restNode(muscle.drag), triangles.data());
        bool needed = false;
        for (const int t : triangles)
            for (int k = 0; k < 3 && t >= 0; ++k)
                needed = needed || rig.sheet.inverseMass[rig.triangles[t][k]] > 0;
        if (!needed) continue;
        rig.pokes.push_back({index, v, static_cast<std::uint32_t>(rig.pokeTriangles.size()), radius});
        rig.pokeTriangles.insert(rig.pokeTriangles.end(), triangles.begin(), triangles.end());
    }
}

} // namespace tss::rig
