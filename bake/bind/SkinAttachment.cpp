#include "bake/bind/SkinAttachment.h"

#include "bake/base/Infinity.h"
#include "bake/base/Order.h"
#include "bake/base/Parallel.h"
#include "bake/bind/SkinNormals.h"
#include "bake/bind/SkinSpans.h"
#include "bake/geometry/Solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

namespace tss {
namespace {

/// Size of the skin divided by SkinAnatomy::length: that is 4 mm on a head of 0.3 m, the thickness of skin
/// and the tissue below it. The length is never less than an edge, which is the finest that the mesh can
/// show.
constexpr double lengthsPerSize = 80;
/// In those lengths: over which distance a muscle's hold on skin decays beyond the tissue on it, and where it
/// ends.
constexpr double holdFall = 0.5, holdReach = 4;
/// Skin that touches a muscle or is inside of it at rest cannot slide along it: how much firmer it is
/// attached than other skin, and over which distance, in those lengths, that decays.
constexpr double touchFirmness = 300, touchFade = 0.03;

/// For each vertex the first one at the same position, if both are on rims of the mesh, as along a seam;
/// itself otherwise. Vertices of lips that touch are not on rims and stay separate.
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
    // The rounding of floats, but no more than a small part of an edge.
    const double near =
        std::min(std::ldexp(farthest, -21), 1e-3 * length / std::max<double>(1, sides.size()));
    using Place = std::array<double, 3>; // a cell of a grid twice as wide
    std::map<Place, std::vector<std::uint32_t>> at;
    const auto placeOf = [&](const Vec3& p) {
        const Vec3 steps = near > 0 ? Vec3((p / (2 * near)).array().floor()) : p;
        return Place{steps[0], steps[1], steps[2]};
    };
    const auto find = [&](std::uint32_t v) {
        const Vec3& p = mesh.vertices[v];
        for (int corner = 0; corner < 8; ++corner) { // these cells hold all vertices within reach
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

/// firstAtPlace(), except for vertices that the scene gives different values: those are not joined.
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
/// thickness is that over the middle one of the vertices with the muscle below them; less beside it and where
/// it is deeper. Raises the firmness of what touches it.
std::vector<double> holdOf(const SkinAnatomy& anatomy, std::size_t m, std::vector<double>& firmness) {
    const std::size_t count = anatomy.skin.vertices.size();
    std::vector<double> depth(count, infinity), aside(count, 0);
    parallelFor(count, [&](std::size_t v) {
        const Vec3& x = anatomy.skin.vertices[v];
        const NearestPoint near = anatomy.locators[m].nearest(x, holdReach * anatomy.length);
        if (near.triangle < 0) return;
        const Vec3 way = anatomy.inside[m][v] ? Vec3::Zero() : Vec3(x - near.point);
        depth[v] = std::max(way.dot(anatomy.normals[v]), 0.0);
        aside[v] = std::sqrt(std::max(way.squaredNorm() - depth[v] * depth[v], 0.0));
    });
    std::vector<double> over;
    std::ranges::copy_if(depth, std::back_inserter(over), [](double d) { return d > 0 && std::isfinite(d); });
    const double tissue = over.empty() ? 0 : median(over);
    std::vector<double> hold(count, 0);
    for (std::size_t v = 0; v < count; ++v) {
        if (!std::isfinite(depth[v])) continue;
        const double touch = (depth[v] + aside[v]) / (touchFade * anatomy.length),
                     away = (aside[v] + std::max(depth[v] - tissue, 0.0)) / (holdFall * anatomy.length);
        firmness[v] = std::max(firmness[v], 1 + (touchFirmness - 1) * std::exp(-touch));
        hold[v] = std::exp(-away);
    }
    return hold;
}

std::vector<std::vector<double>> frameShares(const SkinAnatomy& anatomy, const SkinParameters& p,
                                             const std::vector<int>& frames) {
    const int count = frames.empty() ? 0 : *std::max_element(frames.begin(), frames.end()) + 1;
    if (!p.shares.empty() || count == 0) return p.shares;
    std::vector<std::vector<double>> shares =
        claimedShares(anatomy.skin, anatomy.graph, skinInfluences(anatomy, p, frames),
                      {endMotions(p, frames, static_cast<std::size_t>(count)), p.tether});
    shares.resize(static_cast<std::size_t>(count));
    return shares;
}

/// Whether the bodies are, on average over the area, on the side that the normals point to.
bool isWoundInwards(const SkinAnatomy& anatomy) {
    const std::size_t count = anatomy.skin.vertices.size();
    std::vector<double> outward(count, 0); // area times cosine between normal and direction from the bodies
    parallelFor(count, [&](std::size_t v) {
        const Vec3& x = anatomy.skin.vertices[v];
        NearestPoint nearest{};
        nearest.distance = infinity;
        for (const ClosestPointQuery& body : anatomy.locators)
            if (const NearestPoint near = body.nearest(x, nearest.distance); near.triangle >= 0)
                nearest = near;
        if (nearest.distance < infinity)
            outward[v] = anatomy.graph.area[v] * (x - nearest.point).normalized().dot(anatomy.normals[v]);
    });
    return std::accumulate(outward.begin(), outward.end(), 0.0) < 0;
}

} // namespace

SkinAnatomy::SkinAnatomy(const TriangleMesh& mesh,
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
        const Solid solid(surface);
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

std::vector<int> framesOf(const SkinAnatomy& anatomy, const SkinParameters& parameters) {
    if (!parameters.frames.empty()) return parameters.frames;
    std::vector<int> frames;
    int next = 0;
    for (const auto& body : anatomy.bodies) frames.push_back(body->rigid() ? next++ : -1);
    return frames;
}

std::vector<std::vector<DualPose>> endMotions(const SkinParameters& parameters,
                                              const std::vector<int>& frames, std::size_t count) {
    std::vector<std::vector<DualPose>> ends;
    for (const BoneSwing& swing : parameters.swings) {
        if (swing.empty()) continue;
        std::vector<DualPose>& motion = ends.emplace_back(count);
        for (std::size_t m = 0; m < frames.size(); ++m)
            if (frames[m] >= 0) motion[static_cast<std::size_t>(frames[m])] = DualPose(swing.back()[m]);
    }
    return ends;
}

SkinAttachment attachSkin(const SkinAnatomy& anatomy, const SkinParameters& p) {
    const std::size_t count = anatomy.skin.vertices.size();
    const auto free = [&](std::size_t v) { return p.tether.empty() ? 1 : 1 - p.tether[v]; };
    SkinAttachment attachment;
    attachment.frames = frameShares(anatomy, p, framesOf(anatomy, p));
    for (auto& list : attachment.frames)
        for (std::size_t v = 0; v < count; ++v) list[v] *= free(v);

    std::vector<std::vector<double>> holds;
    std::vector<double> sum(count, 0);
    attachment.firmness.assign(count, 1);
    for (std::size_t m = 0; m < anatomy.bodies.size(); ++m) {
        if (anatomy.bodies[m]->rigid()) continue;
        std::vector<double> hold = holdOf(anatomy, m, attachment.firmness);
        for (std::size_t v = 0; v < count && !p.attach.empty(); ++v) hold[v] *= p.attach[v];
        for (std::size_t v = 0; v < count; ++v) sum[v] += hold[v];
        holds.push_back(std::move(hold));
    }
    for (auto& hold : holds)
        for (std::size_t v = 0; v < count; ++v) hold[v] /= std::max(1.0, sum[v]);
    spreadOver(anatomy.skin, anatomy.graph, anatomy.length, attachment.firmness, holds);

    attachment.muscles.resize(anatomy.bodies.size());
    attachment.bindings.resize(anatomy.bodies.size());
    std::size_t next = 0;
    for (std::size_t m = 0; m < anatomy.bodies.size(); ++m) {
        if (anatomy.bodies[m]->rigid()) continue;
        std::vector<double>& share = attachment.muscles[m] = std::move(holds[next++]);
        attachment.bindings[m].resize(count);
        parallelFor(count, [&](std::size_t v) {
            share[v] = free(v) * withoutLeast(share[v]);
            if (share[v] > 0)
                attachment.bindings[m][v] = anatomy.locators[m].nearest(anatomy.skin.vertices[v], infinity);
        });
    }
    if (p.shares.empty()) followSpans(anatomy, p, attachment);
    const auto join = [&](auto& lists) {
        for (auto& list : lists)
            for (std::size_t v = 0; v < list.size(); ++v) list[v] = list[anatomy.first[v]];
    };
    join(attachment.frames);
    join(attachment.muscles);
    join(attachment.bindings);
    return attachment;
}

} // namespace tss
