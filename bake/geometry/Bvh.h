#pragma once
#include "bake/base/Infinity.h"
#include "bake/geometry/TriangleMesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace tss {

/// A binary hierarchy of axis-aligned boxes in double precision. Embree would be quicker a ray, but its
/// boxes, rays and point queries are floats: at 0.3 units from the origin a float is 3e-8 wide, and the
/// bounds proven with these queries must not depend on that.
struct Bvh {
    struct Node {
        Vec3 lower, upper;
        std::uint32_t first =
            0; ///< leaf: first place in items; inner node: left child, the right one follows it
        std::uint32_t count = 0; ///< number of items; 0 for an inner node
    };
    std::vector<Node> nodes; ///< nodes[0] is the root; a child stands behind its parent; empty without items
    std::vector<std::uint32_t> items; ///< the indices of the boxes given, leaf by leaf

    bool empty() const { return nodes.empty(); }
};

/// Builds the hierarchy by the surface area heuristic over 16 bins; the same input gives the same tree.
/// leafSize: the largest number of items in a leaf, >= 1. stop: asked at each node; once it says true, what
/// is not divided yet stays together in leaves of any size.
Bvh buildBvh(std::span<const Eigen::AlignedBox3d> boxes, std::uint32_t leafSize = 4,
             const std::function<bool()>& stop = {});

/// Over the triangles of a mesh.
Bvh buildBvh(const TriangleMesh& mesh, std::uint32_t leafSize = 4);

/// Puts those items first whose places come first along the axis on which all of them are spread most,
/// `count` of them. placeOf(item): its place. Returns the box about all places.
template <class PlaceOf>
Eigen::AlignedBox3d partAlongLongest(std::span<std::uint32_t> items, std::size_t count,
                                     const PlaceOf& placeOf) {
    Eigen::AlignedBox3d box;
    for (const std::uint32_t item : items) box.extend(placeOf(item));
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    std::ranges::nth_element(items, items.begin() + static_cast<std::ptrdiff_t>(count),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 const double x = placeOf(a)[axis], y = placeOf(b)[axis];
                                 return x != y ? x < y : a < b;
                             });
    return box;
}

inline double squaredDistance(const Bvh::Node& node, const Vec3& p) {
    return (node.lower - p).cwiseMax(p - node.upper).cwiseMax(0.0).squaredNorm();
}

/// Calls leaf(item) for items in roughly rising distance, skipping all in nodes that are no nearer than the
/// square root of best2, which leaf lowers as it finds better ones. distance2(node): how near, squared, what
/// is in the node of this index can be at most.
template <class Distance2, class Leaf>
void visitNearest(const Bvh& bvh, const Distance2& distance2, double& best2, Leaf&& leaf) {
    if (bvh.empty()) return;
    std::array<std::pair<double, std::uint32_t>, 128> stack;
    std::size_t top = 0;
    stack[top++] = {distance2(0u), 0};
    while (top > 0) {
        const auto [least2, index] = stack[--top];
        if (least2 >= best2) continue;
        const Bvh::Node& node = bvh.nodes[index];
        for (std::uint32_t i = 0; i < node.count; ++i) leaf(bvh.items[node.first + i]);
        if (node.count > 0) continue;
        std::pair<double, std::uint32_t> near{distance2(node.first), node.first};
        std::pair<double, std::uint32_t> far{distance2(node.first + 1), node.first + 1};
        if (far.first < near.first) std::swap(near, far);
        if (far.first < best2) stack[top++] = far;
        if (near.first < best2) stack[top++] = near;
    }
}

/// The same by the distance of their boxes from p.
template <class Leaf>
void visitNearest(const Bvh& bvh, const Vec3& p, double& best2, Leaf&& leaf) {
    visitNearest(
        bvh, [&](std::uint32_t node) { return squaredDistance(bvh.nodes[node], p); }, best2, leaf);
}

/// Calls leaf(item) for every item whose box comes within `radius` of p, in the order of the tree.
template <class Leaf>
void visitBall(const Bvh& bvh, const Vec3& p, double radius, Leaf&& leaf) {
    double radius2 = std::nextafter(radius * radius, infinity);
    visitNearest(bvh, p, radius2, leaf);
}

} // namespace tss
