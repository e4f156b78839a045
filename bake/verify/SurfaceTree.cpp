#include "bake/verify/SurfaceTree.h"

#include "bake/base/Error.h"
#include "bake/base/Order.h"
#include "bake/geometry/MeshAudit.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace tss::verify {

namespace {

/// A hair for the rounding of what stands here: of differences of coordinates, and of a few sums.
constexpr double outwardHere = 1 + 1e-13;
constexpr double hair = 4e-16;

Vec3 unitOr(const Vec3& v, const Vec3& fallback) {
    const double length = v.norm();
    return length > 1e-150 ? Vec3(v / length) : fallback;
}

/// The middle of the circle about the three corners, or of the longest edge where that sees the third corner
/// from inside the circle over it.
Vec3 circleCentre(const Corners& c) {
    const Vec3 ab = c[1] - c[0], ac = c[2] - c[0], bc = c[2] - c[1];
    const double b2 = ab.squaredNorm(), c2 = ac.squaredNorm(), a2 = bc.squaredNorm();
    if (a2 >= b2 + c2) return c[1] + 0.5 * bc;
    if (b2 >= a2 + c2) return c[0] + 0.5 * ab;
    if (c2 >= a2 + b2) return c[0] + 0.5 * ac;
    const Vec3 normal = ab.cross(ac);
    if (!(normal.squaredNorm() > 0)) return (c[0] + c[1] + c[2]) / 3;
    return c[0] + (c2 * normal.cross(ab) + b2 * ac.cross(normal)) / (2 * normal.squaredNorm());
}

/// Grows a slab of a given centre and axis to hold the points.
template <typename Points>
void hold(Slab& slab, const Points& points) {
    double size = slab.centre.lpNorm<Eigen::Infinity>();
    for (const Vec3& p : points) {
        const Vec3 arm = p - slab.centre;
        const double along = slab.axis.dot(arm);
        slab.half = std::max(slab.half, std::abs(along));
        slab.radius = std::max(slab.radius, (arm - along * slab.axis).norm());
        slab.reach = std::max(slab.reach, arm.norm());
        size = std::max(size, p.lpNorm<Eigen::Infinity>());
    }
    for (double* bound : {&slab.half, &slab.radius, &slab.reach})
        *bound = *bound * outwardHere + hair * (size + slab.reach);
}

/// Cuts a triangle until every piece is one of the parts or has nothing in common with any.
void addPatches(std::vector<SurfacePatch>& patches, const Corners& corners, SurfacePart at,
                std::span<const SurfacePart> parts) {
    const auto within = [&](const SurfacePart& part) { // `at` lies in part
        const int more = std::bit_width(at.cuts) - std::bit_width(part.cuts);
        return more >= 0 && at.cuts >> more == part.cuts;
    };
    const bool exempt = std::any_of(parts.begin(), parts.end(), within);
    if (exempt || parts.empty()) {
        patches.push_back({corners, at.triangle, exempt});
        return;
    }
    const std::array<Corners, 2> both = halves(corners);
    for (std::uint32_t side = 0; side < 2; ++side) {
        const SurfacePart half{at.triangle, at.cuts << 1 | side};
        std::vector<SurfacePart> inside;
        for (const SurfacePart& part : parts)
            if (part.cuts >> (std::bit_width(part.cuts) - std::bit_width(half.cuts)) == half.cuts)
                inside.push_back(part);
        addPatches(patches, both[side], half, inside);
    }
}

} // namespace

double Slab::support(const Vec3& direction) const {
    const double along = axis.dot(direction), length = direction.norm();
    const double across = (direction - along * axis).norm();
    return std::min(std::abs(along) * half + across * radius + 1e-15 * length * reach, length * reach) *
           outwardHere;
}

double Slab::farthest(const Vec3& p) const {
    const Vec3 arm = centre - p;
    const double along = std::abs(axis.dot(arm));
    const double across = (arm - axis.dot(arm) * axis).norm();
    return std::min(Eigen::Vector2d(along + half, across + radius).norm(), arm.norm() + reach) * outwardHere +
           hair * (centre.norm() + p.norm());
}

double Shape::support(const Vec3& direction) const {
    if (!corners) return slab.support(direction);
    double most = -std::numeric_limits<double>::infinity();
    for (const Vec3& corner : *corners) most = std::max(most, direction.dot(corner - slab.centre));
    return most + hair * direction.norm() * (slab.reach + 4 * slab.centre.lpNorm<Eigen::Infinity>());
}

Slab slabOf(const Corners& corners) {
    Slab slab;
    slab.centre = circleCentre(corners);
    slab.axis = unitOr((corners[1] - corners[0]).cross(corners[2] - corners[0]), Vec3::UnitX());
    hold(slab, corners);
    return slab;
}

SurfaceTree::SurfaceTree(const TriangleMesh& mesh, std::span<const SurfacePart> parts) {
    std::vector<SurfacePart> sorted(parts.begin(), parts.end());
    std::sort(sorted.begin(), sorted.end());
    for (const SurfacePart& part : sorted)
        if (part.triangle >= mesh.triangles.size() || part.cuts == 0)
            throw InputError("region at rest: expected parts of the mesh's triangles");
    // Doubles, and triangles without area that lie on others: those stand for them, exempt or not.
    std::vector<std::uint32_t> kept = indicesOf(mesh.triangles.size());
    if (auditMesh(mesh).usable()) cleaned(mesh, &kept);
    auto part = sorted.begin();
    for (const std::uint32_t t : kept) {
        part = std::find_if(part, sorted.end(), [&](const auto& p) { return p.triangle >= t; });
        const auto end = std::find_if(part, sorted.end(), [&](const auto& p) { return p.triangle != t; });
        addPatches(patches, corners(mesh, {t, 1}), {t, 1}, {part, end});
        part = end;
    }
    std::vector<std::uint32_t> order = indicesOf(patches.size());
    nodes.reserve(2 * patches.size());
    if (!patches.empty()) join(order, 0, order.size());
}

std::int32_t SurfaceTree::join(std::vector<std::uint32_t>& order, std::size_t from, std::size_t to) {
    Node node;
    if (to - from == 1) {
        const SurfacePatch& patch = patches[order[from]];
        node.slab = slabOf(patch.corners);
        node.patch = order[from];
        node.exempt = patch.exempt;
        nodes.push_back(node);
        return root();
    }
    const auto at = [&](std::size_t k) { return order.begin() + k; };
    const auto middleOf = [&](std::uint32_t p) -> Vec3 {
        return (patches[p].corners[0] + patches[p].corners[1] + patches[p].corners[2]) / 3;
    };
    Eigen::AlignedBox3d box, middles;
    Vec3 normal = Vec3::Zero();
    std::vector<Vec3> points;
    points.reserve(3 * (to - from));
    for (std::size_t k = from; k < to; ++k) {
        const Corners& c = patches[order[k]].corners;
        normal += (c[1] - c[0]).cross(c[2] - c[0]);
        middles.extend(middleOf(order[k]));
        for (const Vec3& corner : c) {
            box.extend(corner);
            points.push_back(corner);
        }
    }
    Eigen::Index flat = 0;
    box.sizes().minCoeff(&flat);
    node.slab.centre = box.center();
    node.slab.axis = unitOr(normal, Vec3::Unit(flat));
    hold(node.slab, points);
    points = {};

    Eigen::Index axis = 0;
    middles.sizes().maxCoeff(&axis);
    const std::size_t middle = from + (to - from) / 2;
    std::nth_element(at(from), at(middle), at(to), [&](std::uint32_t x, std::uint32_t y) {
        const double cx = middleOf(x)[axis], cy = middleOf(y)[axis];
        return cx != cy ? cx < cy : x < y;
    });
    node.first = join(order, from, middle);
    node.second = join(order, middle, to);
    node.exempt = nodes[static_cast<std::size_t>(node.first)].exempt &&
                  nodes[static_cast<std::size_t>(node.second)].exempt;
    nodes.push_back(node);
    return root();
}

Piece half(const SurfaceTree& tree, Piece piece, std::uint32_t side) {
    const SurfaceTree::Node& node = tree.nodes[static_cast<std::size_t>(piece.node)];
    if (node.first >= 0) return {side ? node.second : node.first, 1};
    return {piece.node, piece.cuts << 1 | side};
}

bool divisible(const SurfaceTree& tree, Piece piece) {
    return tree.nodes[static_cast<std::size_t>(piece.node)].first >= 0 ||
           std::bit_width(piece.cuts) < mostCuts;
}

Shape PieceShapes::of(Piece piece) {
    const SurfaceTree::Node& node = tree_.nodes[static_cast<std::size_t>(piece.node)];
    if (node.first >= 0) return {node.slab, {}};
    if (piece.cuts == 1) return {node.slab, tree_.patches[node.patch].corners};
    const std::uint32_t mixed = static_cast<std::uint32_t>(piece.node) * 0x9E3779B1u + piece.cuts;
    Kept& kept = kept_[(mixed ^ mixed >> 16) % count];
    if (kept.piece == piece) return kept.shape;
    const Corners corners = halves(*of({piece.node, piece.cuts >> 1}).corners)[piece.cuts & 1];
    kept = {piece, {slabOf(corners), corners}};
    return kept.shape;
}

} // namespace tss::verify
