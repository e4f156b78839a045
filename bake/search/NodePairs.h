#pragma once
#include "bake/motion/Motion.h"
#include "bake/search/SphereTree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tss {

/// A node of the tree over A's spheres and one of the tree over B's.
struct NodePair {
    std::uint32_t a = 0, b = 0;
};

/// The two pairs that replace one which is not a pair of leaves: the node with the larger ball is replaced by
/// its children.
inline std::array<NodePair, 2> opened(const SphereTree& a, const SphereTree& b, NodePair pair) {
    const SphereTree::Node &na = a[pair.a], &nb = b[pair.b];
    if (!na.leaf() && (nb.leaf() || na.radius >= nb.radius))
        return {NodePair{pair.a + 1, pair.b}, NodePair{na.right, pair.b}};
    return {NodePair{pair.a, pair.b + 1}, NodePair{pair.a, nb.right}};
}

/// Depth-first traversal of both trees at once, from the pairs on the stack, which is empty afterwards. Where
/// open(pair, node of A, node of B) is true, the pairs below are visited as well; it must be false for
/// leaves.
template <typename Open>
void descend(const SphereTree& a, const SphereTree& b, std::vector<NodePair>& stack, Open&& open) {
    while (!stack.empty()) {
        const NodePair pair = stack.back();
        stack.pop_back();
        if (!open(pair, a[pair.a], b[pair.b])) continue;
        const auto [first, second] = opened(a, b, pair);
        stack.push_back(second);
        stack.push_back(first);
    }
}

/// Calls visit(i, j, gap) for every sphere i of A and j of B whose gap at the pose is <= reach (the gap as it
/// is calculated: none is lost to the rounding of the balls about it), in an order that depends on the trees
/// alone. A visit that returns false is the last one; it may return nothing.
template <typename Visit>
void visitPairsWithin(const SphereTree& a, const SphereTree& b, const Pose& pose, double reach,
                      Visit&& visit) {
    if (a.empty() || b.empty()) return;
    const double rounding = 0x1p-48 * (a.extent() + b.extent() + pose.translation().norm());
    std::vector<NodePair> stack{{0, 0}};
    bool more = true;
    std::uint32_t last = 0;
    Vec3 centreB = pose * b[0].centre; // of node `last`, in A's frame
    descend(a, b, stack, [&](NodePair pair, const SphereTree::Node& na, const SphereTree::Node& nb) {
        const double sum = na.radius + nb.radius, limit = sum + reach + rounding;
        if (!more || limit < 0) return false;
        if (pair.b != last) centreB = pose * b[last = pair.b].centre;
        const double squared = (centreB - na.centre).squaredNorm();
        if (squared > limit * limit) return false;
        if (!na.leaf() || !nb.leaf()) return true;
        const double gap = std::sqrt(squared) - sum;
        if (gap > reach) return false;
        if constexpr (std::is_void_v<decltype(visit(na.sphere, nb.sphere, gap))>)
            visit(na.sphere, nb.sphere, gap);
        else
            more = visit(na.sphere, nb.sphere, gap);
        return false;
    });
}

/// Branch and bound: the least value of leaf(i, j) over the spheres i of A and j of B below the given pairs
/// of nodes, or `atMost` where none is smaller. leaf(i, j) must not be below the gap of the spheres at the
/// pose.
template <typename Leaf>
double leastBelow(const SphereTree& a, const SphereTree& b, const Pose& pose, std::span<const NodePair> from,
                  double atMost, Leaf&& leaf) {
    struct Item {
        NodePair nodes;
        double lower; ///< no pair below has a smaller gap
    };
    const auto item = [&](NodePair nodes) {
        const SphereTree::Node &na = a[nodes.a], &nb = b[nodes.b];
        return Item{nodes, (pose * nb.centre - na.centre).norm() - na.radius - nb.radius};
    };
    std::vector<Item> stack;
    for (const NodePair& nodes : from) stack.push_back(item(nodes));
    while (!stack.empty()) {
        const Item at = stack.back();
        stack.pop_back();
        if (at.lower >= atMost) continue;
        const SphereTree::Node &na = a[at.nodes.a], &nb = b[at.nodes.b];
        if (na.leaf() && nb.leaf()) {
            atMost = std::min(atMost, leaf(na.sphere, nb.sphere));
            continue;
        }
        const auto [first, second] = opened(a, b, at.nodes);
        Item near = item(first), far = item(second);
        if (near.lower > far.lower) std::swap(near, far);
        stack.push_back(far);
        stack.push_back(near);
    }
    return atMost;
}

/// The smallest gap over all pairs at the pose, or `atMost` when none is smaller.
inline double smallestGap(const SphereTree& a, const SphereTree& b, const Pose& pose, double atMost) {
    if (a.empty() || b.empty()) return atMost;
    const NodePair roots[] = {{0, 0}};
    return leastBelow(a, b, pose, roots, atMost, [&](std::uint32_t i, std::uint32_t j) {
        const SphereTree::Node &na = a[a.leafOf(i)], &nb = b[b.leafOf(j)];
        return (pose * nb.centre - na.centre).norm() - na.radius - nb.radius;
    });
}

} // namespace tss
