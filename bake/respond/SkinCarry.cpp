#include "bake/respond/SkinCarry.h"

#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/geometry/MeshQuery.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace tss {
namespace {

/// Lengths per size of the skin over which it gives way: 4 mm on a head of 0.3 m, the thickness of skin and
/// what is below it. Never less than an edge, which could not show it.
constexpr double lengthsPerSize = 80;
/// In those lengths: how fast a muscle's hold falls off beyond the tissue on it, and how far from the muscle
/// it ends.
constexpr double holdFall = 0.5, holdReach = 4;
/// Skin that is inside a muscle at rest cannot slide along it, nor can skin that touches it: how much firmer
/// than other skin it is held, and over which distance in those lengths that fades.
constexpr double touchFirmness = 300, touchFade = 0.03;
/// Skin lies over a muscle where the muscle is below it, by at most this much to the side per depth.
constexpr double besideOver = 0.6;
/// A share below this counts as none, so that what hardly moves is left alone; the others are lowered by it.
constexpr double leastShare = 1e-3;

double withoutLeast(double share) {
    return share > leastShare ? (share - leastShare) / (1 - leastShare) : 0;
}

/// The same for all shares of each vertex, of which what holds still has the rest: 1 together as before.
void dropLeast(std::vector<std::vector<double>>& shares) {
    for (std::size_t v = 0; !shares.empty() && v < shares[0].size(); ++v) {
        double still = 1, sum = 0;
        for (auto& list : shares) {
            still -= list[v];
            sum += list[v] = withoutLeast(list[v]);
        }
        sum += withoutLeast(still);
        for (auto& list : shares) list[v] /= sum;
    }
}

/// Of each vertex the first at its place, where both are on rims as along a seam; lips that touch are two.
std::vector<std::uint32_t> firstAtPlace(const TriangleMesh& mesh) {
    std::map<std::pair<int, int>, int> sides; // of each edge
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) ++sides[std::minmax({t[k], t[(k + 1) % 3]})];
    std::vector<char> rim(mesh.vertices.size(), 0);
    double length = 0, farthest = 0;
    for (const auto& [edge, count] : sides) {
        length += (mesh.vertices[edge.first] - mesh.vertices[edge.second]).norm();
        if (count == 1) rim[edge.first] = rim[edge.second] = 1;
    }
    for (const Vec3& p : mesh.vertices) farthest = std::max(farthest, p.cwiseAbs().maxCoeff());
    // What floats may have rounded, as long as that is nothing beside an edge.
    const double near =
        std::min(std::ldexp(farthest, -21), 1e-3 * length / std::max<double>(1, sides.size()));
    using Place = std::array<double, 3>; // in steps of twice that
    std::map<Place, std::vector<std::uint32_t>> at;
    const auto placeOf = [&](const Vec3& p) {
        const Vec3 steps = near > 0 ? Vec3((p / (2 * near)).array().floor()) : p;
        return Place{steps[0], steps[1], steps[2]};
    };
    const auto find = [&](std::uint32_t v) {
        const Vec3& p = mesh.vertices[v];
        for (int corner = 0; corner < 8; ++corner) { // all within reach are in these
            const Vec3 side((corner & 1) ? near : -near, (corner & 2) ? near : -near,
                            (corner & 4) ? near : -near);
            const auto found = at.find(placeOf(p + side));
            if (found == at.end()) continue;
            for (const std::uint32_t other : found->second)
                if ((mesh.vertices[other] - p).norm() <= near) return other;
        }
        at[placeOf(p)].push_back(v);
        return v;
    };
    std::vector<std::uint32_t> first;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) first.push_back(rim[v] ? find(v) : v);
    return first;
}

/// What the scene says of the two apart makes them two: rims of lips that touch.
std::vector<std::uint32_t> seamsOf(const TriangleMesh& mesh, const SkinParameters& p) {
    std::vector<std::uint32_t> first = firstAtPlace(mesh);
    for (std::uint32_t v = 0; v < first.size(); ++v) {
        const auto differs = [&](const std::vector<double>& list) {
            return !list.empty() && list[v] != list[first[v]];
        };
        if (differs(p.tether) || differs(p.attach) || std::ranges::any_of(p.shares, differs)) first[v] = v;
    }
    return first;
}

TriangleMesh joined(const TriangleMesh& mesh, const std::vector<std::uint32_t>& first) {
    TriangleMesh result{mesh.vertices, {}};
    for (const Tri& t : mesh.triangles) {
        const Tri at =
            t.unaryExpr([&](int v) { return static_cast<int>(first[static_cast<std::size_t>(v)]); });
        if (at[0] != at[1] && at[1] != at[2] && at[2] != at[0]) result.triangles.push_back(at);
    }
    return result;
}

/// How firmly skin goes with a muscle, #V, 0 to 1: wholly over it, through the tissue between the two, whose
/// thickness is that over the middle one of the vertices over the muscle; less beside it and where it is
/// deeper. Raises the firmness of what touches it.
std::vector<double> holdOf(const SkinGround& ground, std::size_t m, std::vector<double>& firmness) {
    const std::size_t count = ground.skin.vertices.size();
    std::vector<double> depth(count, infinity), aside(count, 0);
    parallelFor(count, [&](std::size_t v) {
        const Vec3& x = ground.skin.vertices[v];
        const NearestPoint near = ground.locators[m].nearest(x, holdReach * ground.length);
        if (near.triangle < 0) return;
        const Vec3 way = ground.inside[m][v] ? Vec3::Zero() : Vec3(x - near.point);
        depth[v] = std::max(way.dot(ground.normals[v]), 0.0);
        aside[v] = std::sqrt(std::max(way.squaredNorm() - depth[v] * depth[v], 0.0));
    });
    std::vector<double> over;
    for (std::size_t v = 0; v < count; ++v)
        if (std::isfinite(depth[v]) && aside[v] <= besideOver * depth[v]) over.push_back(depth[v]);
    const auto middle = over.begin() + static_cast<std::ptrdiff_t>(over.size() / 2);
    std::nth_element(over.begin(), middle, over.end());
    const double tissue = over.empty() ? 0 : *middle;
    std::vector<double> hold(count, 0);
    for (std::size_t v = 0; v < count; ++v) {
        if (!std::isfinite(depth[v])) continue;
        const double touch = (depth[v] + aside[v]) / (touchFade * ground.length),
                     away = (aside[v] + std::max(depth[v] - tissue, 0.0)) / (holdFall * ground.length);
        firmness[v] = std::max(firmness[v], 1 + (touchFirmness - 1) * std::exp(-touch));
        hold[v] = std::exp(-away);
    }
    return hold;
}

std::vector<std::vector<double>> frameShares(const SkinGround& ground, const SkinParameters& p,
                                             const std::vector<int>& frames) {
    const int count = frames.empty() ? 0 : *std::max_element(frames.begin(), frames.end()) + 1;
    if (!p.shares.empty() || count == 0) return p.shares;
    SkinStrokes strokes{{}, p.tether};
    for (const BoneSwing& swing : p.swings) {
        if (swing.empty()) continue;
        std::vector<DualPose>& motion = strokes.motions.emplace_back(static_cast<std::size_t>(count));
        for (std::size_t m = 0; m < frames.size(); ++m)
            if (frames[m] >= 0) motion[static_cast<std::size_t>(frames[m])] = DualPose(swing.back()[m]);
    }
    std::vector<std::vector<double>> shares =
        claimedShares(ground.skin, ground.graph, skinHolders(ground, p, frames), strokes);
    shares.resize(static_cast<std::size_t>(count));
    return shares;
}

/// Whether what lies under the skin is rather where its normals point to.
bool isWoundInwards(const SkinGround& ground) {
    const std::size_t count = ground.skin.vertices.size();
    std::vector<double> outward(count, 0); // each vertex's area, by how far its normal points away
    parallelFor(count, [&](std::size_t v) {
        const Vec3& x = ground.skin.vertices[v];
        NearestPoint nearest{};
        nearest.distance = infinity;
        for (const ClosestPointQuery& body : ground.locators)
            if (const NearestPoint near = body.nearest(x, nearest.distance); near.triangle >= 0)
                nearest = near;
        if (nearest.distance < infinity)
            outward[v] = ground.graph.area[v] * (x - nearest.point).normalized().dot(ground.normals[v]);
    });
    return std::accumulate(outward.begin(), outward.end(), 0.0) < 0;
}

} // namespace

SkinGround::SkinGround(const TriangleMesh& mesh,
                       const std::vector<std::shared_ptr<const MuscleDeformer>>& under,
                       const SkinParameters& parameters)
    : first(seamsOf(mesh, parameters)), skin(joined(mesh, first)), bodies(under), graph(skinGraph(skin)),
      normals(skinNormals(skin)) {
    locators.reserve(bodies.size());
    for (const auto& body : bodies) {
        const TriangleMesh& surface = body->muscle().surface;
        locators.emplace_back(surface);
        surfaceNormals.push_back(vertexNormals(surface));
        inside.emplace_back();
        if (body->rigid()) continue;
        const MeshQuery solid(surface);
        const Eigen::AlignedBox3d box = bounds(surface);
        std::vector<char> within(mesh.vertices.size(), 0);
        parallelFor(within.size(), [&](std::size_t v) {
            within[v] = box.contains(mesh.vertices[v]) && solid.inside(mesh.vertices[v]);
        });
        inside.back().assign(within.begin(), within.end());
    }
    inverted = isWoundInwards(*this);
    if (inverted) {
        for (Tri& t : skin.triangles) std::swap(t[1], t[2]);
        for (Vec3& normal : normals) normal = -normal;
    }
    Eigen::AlignedBox3d box;
    for (const Tri& t : mesh.triangles)
        for (const int v : t) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
    if (!box.isEmpty()) {
        centre = box.center();
        size = box.diagonal().norm();
    }
    if (!(size > 0)) size = 1;
    length = std::max(size / lengthsPerSize, graph.meanEdge);
}

std::vector<int> framesOf(const SkinGround& ground, const SkinParameters& parameters) {
    if (!parameters.frames.empty()) return parameters.frames;
    std::vector<int> frames;
    int next = 0;
    for (const auto& body : ground.bodies) frames.push_back(body->rigid() ? next++ : -1);
    return frames;
}

SkinCarriage carrySkin(const SkinGround& ground, const SkinParameters& p) {
    const std::size_t count = ground.skin.vertices.size();
    const auto free = [&](std::size_t v) { return p.tether.empty() ? 1 : 1 - p.tether[v]; };
    SkinCarriage carriage;
    carriage.frames = frameShares(ground, p, framesOf(ground, p));
    if (p.shares.empty()) dropLeast(carriage.frames);
    for (auto& list : carriage.frames)
        for (std::size_t v = 0; v < count; ++v) list[v] *= free(v);

    std::vector<std::vector<double>> holds;
    std::vector<double> sum(count, 0);
    carriage.firmness.assign(count, 1);
    for (std::size_t m = 0; m < ground.bodies.size(); ++m) {
        if (ground.bodies[m]->rigid()) continue;
        std::vector<double> hold = holdOf(ground, m, carriage.firmness);
        for (std::size_t v = 0; v < count && !p.attach.empty(); ++v) hold[v] *= p.attach[v];
        for (std::size_t v = 0; v < count; ++v) sum[v] += hold[v];
        holds.push_back(std::move(hold));
    }
    for (auto& hold : holds)
        for (std::size_t v = 0; v < count; ++v) hold[v] /= std::max(1.0, sum[v]);
    spreadOver(ground.skin, ground.graph, ground.length, carriage.firmness, holds);

    carriage.muscles.resize(ground.bodies.size());
    carriage.bound.resize(ground.bodies.size());
    std::size_t next = 0;
    for (std::size_t m = 0; m < ground.bodies.size(); ++m) {
        if (ground.bodies[m]->rigid()) continue;
        std::vector<double>& share = carriage.muscles[m] = std::move(holds[next++]);
        carriage.bound[m].resize(count);
        parallelFor(count, [&](std::size_t v) {
            share[v] = free(v) * withoutLeast(share[v]);
            if (share[v] > 0)
                carriage.bound[m][v] = ground.locators[m].nearest(ground.skin.vertices[v], infinity);
        });
    }
    const auto join = [&](auto& lists) {
        for (auto& list : lists)
            for (std::size_t v = 0; v < list.size(); ++v) list[v] = list[ground.first[v]];
    };
    join(carriage.frames);
    join(carriage.muscles);
    join(carriage.bound);
    return carriage;
}

} // namespace tss
