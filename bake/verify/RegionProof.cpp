#include "bake/verify/RegionProof.h"

#include "bake/base/UnionFind.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/PartSet.h"
#include "bake/geometry/TriangleDistance.h"

#include <fmt/format.h>

#include <algorithm>

namespace tss::verify {

namespace {

/// The parts, in pieces that hang together.
std::vector<std::vector<SurfacePart>> pieces(const TriangleMesh& mesh,
                                             const std::vector<SurfacePart>& parts) {
    std::vector<Corners> all;
    std::vector<Eigen::AlignedBox3d> boxes;
    for (const SurfacePart& part : parts) {
        all.push_back(corners(mesh, part));
        boxes.emplace_back(all.back()[0]);
        for (const Vec3& c : all.back()) boxes.back().extend(c);
    }
    // What is this near touches: the bake joins what is nearer than 1e-9 of the mesh's size; halves of edges
    // round.
    const Eigen::AlignedBox3d whole = bounds(mesh);
    const double touching = 1.01e-9 * whole.diagonal().norm() +
                            1e-15 * whole.min().cwiseAbs().cwiseMax(whole.max().cwiseAbs()).norm();
    UnionFind together(parts.size());
    const Bvh tree = buildBvh(boxes);
    for (std::size_t i = 0; i < all.size(); ++i)
        visitBall(tree, boxes[i].center(), 0.5 * boxes[i].diagonal().norm() + touching, [&](std::uint32_t j) {
            if (j >= i || together.root(i) == together.root(j)) return;
            if (squaredDistanceOfTriangles(all[i], all[j]) <= touching * touching) together.join(i, j);
        });
    std::vector<std::vector<SurfacePart>> found(parts.size());
    for (std::size_t i = 0; i < all.size(); ++i) found[together.root(i)].push_back(parts[i]);
    std::erase_if(found, [](const auto& piece) { return piece.empty(); });
    return found;
}

/// A share of the smaller body's diagonal.
constexpr double closeShare = 0.02;

/// How far the piece, moved, is from the body, what closes its openings counted; 0: it is in it.
double distanceTo(const VerifiedBody& body, const TriangleMesh& piece, const Pose& toBody) {
    for (const Vec3& corner : piece.vertices)
        if (body.solid && body.solid->inside(toBody * corner)) return 0;
    const MeshQuery surface(piece);
    const double distance = body.surface.distanceTo(surface, toBody);
    return body.solid ? std::min(distance, body.solid->boundary().distanceTo(surface, toBody)) : distance;
}

} // namespace

VerifiedBody::VerifiedBody(const TriangleMesh& mesh) : mesh(mesh), surface(mesh) {
    if (auditMesh(mesh).usable()) solid.emplace(cleaned(mesh));
}

ExemptShare exemptShare(const TriangleMesh& a, const TriangleMesh& b, const RestRegion& region) {
    const auto shareOf = [](const TriangleMesh& mesh, double exempt) {
        const double whole = area(mesh);
        return whole > 0 ? exempt / whole : 0;
    };
    const double areaA = area(a, region.a), areaB = area(b, region.b);
    return {areaA, areaB, shareOf(a, areaA), shareOf(b, areaB)};
}

RegionVerdict judgeRegion(const VerifiedBody& a, const VerifiedBody& b, const Motion& motion,
                          const RestRegion& region) {
    RegionVerdict verdict;
    if (region.empty()) return verdict;
    const Pose rest = pose(motion, restValues(motion));
    // Files hold points as floats, and placing them rounds in double.
    const double smaller = std::min(diagonal(a.mesh), diagonal(b.mesh));
    const double far = rest.translation().norm() + bounds(a.mesh).max().cwiseAbs().norm() +
                       bounds(a.mesh).min().cwiseAbs().norm() + bounds(b.mesh).max().cwiseAbs().norm() +
                       bounds(b.mesh).min().cwiseAbs().norm();
    const double rounding = 0x1p-22 * smaller + 1e-12 * far;
    if (a.surface.apart(b.surface, rest, rounding)) {
        verdict.reason = "it excepts parts of the surfaces though the meshes do not meet at rest";
        return verdict;
    }
    int strays = 0;
    const auto probe = [&](const VerifiedBody& body, const std::vector<SurfacePart>& parts,
                           const VerifiedBody& other, const Pose& toOther) {
        for (const auto& piece : pieces(body.mesh, parts)) {
            const double distance = distanceTo(other, meshOf(body.mesh, piece), toOther);
            if (distance > rounding) verdict.farthest = std::max(verdict.farthest, distance);
            strays += distance > closeShare * smaller + rounding;
        }
    };
    probe(a, region.a, b, rest.inverse(Eigen::Isometry));
    probe(b, region.b, a, rest);
    if (strays > 0)
        verdict.reason = fmt::format("{} connected pieces of the surfaces that it excepts are nowhere near "
                                     "the other body at rest: up to {:.4g} scene units away",
                                     strays, verdict.farthest);
    return verdict;
}

} // namespace tss::verify
