#pragma once
#include "bake/compare/CollisionMethod.h"
#include "bake/compare/MinBall.h"

namespace tss::compare {

/// A tree of balls with any number of children. The children of a node stand side by side, behind it.
struct EnclosingTree {
    struct Node {
        Vec3 centre = Vec3::Zero();
        double radius = 0;
        std::uint32_t first = 0; ///< first child; of a leaf of buildEnclosingTree() the sphere
        std::uint32_t count = 0; ///< number of children; 0: a leaf, one of the model's spheres
    };
    std::vector<Node> nodes; ///< the root first; empty for no spheres

    std::size_t bytes() const { return nodes.size() * sizeof(Node); }
};

/// Splits a sphere set top down at the median of the longest axis into `arity` = 2, 4 or 8 children; each
/// ball contains the spheres below it whole.
EnclosingTree buildEnclosingTree(const SphereSet& spheres, int arity, Enclosure enclosure);

/// Calls visit(node of A, node of B) for what takes the place of a pair that is not one of two leaves: the
/// larger ball is opened. True, and no more calls, as soon as a visit says so.
template <class Visit>
bool openLarger(const EnclosingTree& a, const EnclosingTree& b, std::uint32_t ia, std::uint32_t ib,
                Visit&& visit) {
    const EnclosingTree::Node &na = a.nodes[ia], &nb = b.nodes[ib];
    const bool openA = nb.count == 0 || (na.count > 0 && na.radius >= nb.radius);
    const EnclosingTree::Node& opened = openA ? na : nb;
    for (std::uint32_t k = opened.first; k < opened.first + opened.count; ++k)
        if (openA ? visit(k, ib) : visit(ia, k)) return true;
    return false;
}

/// Do leaves of the two trees overlap? Depth first, the larger ball opened, first hit out.
template <class Counter>
bool treesTouch(const EnclosingTree& a, const EnclosingTree& b, const Pose& pose, Counter& counter) {
    if (a.nodes.empty() || b.nodes.empty()) return false;
    struct Item {
        std::uint32_t a, b;
        Vec3 centreB; ///< in A's frame
    };
    thread_local std::vector<Item> stack;
    stack.clear();
    const auto test = [&](std::uint32_t ia, std::uint32_t ib, const Vec3& centreB) {
        counter.sphereTest();
        const double sum = a.nodes[ia].radius + b.nodes[ib].radius;
        if ((a.nodes[ia].centre - centreB).squaredNorm() > sum * sum) return false;
        stack.push_back({ia, ib, centreB});
        return a.nodes[ia].count == 0 && b.nodes[ib].count == 0;
    };
    if (test(0, 0, pose * b.nodes[0].centre)) return true;
    while (!stack.empty()) {
        const Item item = stack.back();
        stack.pop_back();
        const auto visit = [&](std::uint32_t ia, std::uint32_t ib) {
            return test(ia, ib, ib == item.b ? item.centreB : Vec3(pose * b.nodes[ib].centre));
        };
        if (openLarger(a, b, item.a, item.b, visit)) return true;
    }
    return false;
}

/// Smallest gap of two leaves, best first by branch and bound; +infinity for an empty tree.
double treesGap(const EnclosingTree& a, const EnclosingTree& b, const Pose& pose);

} // namespace tss::compare
