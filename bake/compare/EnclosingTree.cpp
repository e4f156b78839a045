#include "bake/compare/EnclosingTree.h"

#include "bake/base/Order.h"
#include "bake/geometry/Bvh.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace tss::compare {

namespace {

/// Halves a range of indices at the median of the longest axis of the centres, `levels` times.
void split(const SphereSet& spheres, std::span<std::uint32_t> range, int levels,
           std::vector<std::span<std::uint32_t>>& parts) {
    if (levels == 0 || range.size() < 2) {
        parts.push_back(range);
        return;
    }
    partAlongLongest(range, range.size() / 2, [&](std::uint32_t i) { return spheres[i].centre; });
    split(spheres, range.subspan(0, range.size() / 2), levels - 1, parts);
    split(spheres, range.subspan(range.size() / 2), levels - 1, parts);
}

} // namespace

EnclosingTree buildEnclosingTree(const SphereSet& spheres, int arity, Enclosure enclosure) {
    const int levels = arity >= 8 ? 3 : arity >= 4 ? 2 : 1;
    EnclosingTree tree;
    if (spheres.empty()) return tree;
    std::vector<std::uint32_t> order = indicesOf(spheres.size());
    struct Open {
        std::uint32_t node;
        std::span<std::uint32_t> range;
    };
    std::vector<Open> open{{0, order}};
    tree.nodes.emplace_back();
    SphereSet below;
    for (std::size_t next = 0; next < open.size(); ++next) { // breadth first: children stand side by side
        const Open item = open[next];
        below.clear();
        for (const std::uint32_t i : item.range) below.push_back(spheres[i]);
        const Sphere ball = enclosingBall(below, enclosure);
        EnclosingTree::Node node{ball.centre, ball.radius, item.range.front(), 0};
        if (item.range.size() > 1) {
            std::vector<std::span<std::uint32_t>> parts;
            split(spheres, item.range, levels, parts);
            node.first = static_cast<std::uint32_t>(tree.nodes.size());
            node.count = static_cast<std::uint32_t>(parts.size());
            for (const auto& part : parts) {
                open.push_back({static_cast<std::uint32_t>(tree.nodes.size()), part});
                tree.nodes.emplace_back();
            }
        }
        tree.nodes[item.node] = node;
    }
    return tree;
}

double treesGap(const EnclosingTree& a, const EnclosingTree& b, const Pose& pose) {
    double best = std::numeric_limits<double>::infinity();
    if (a.nodes.empty() || b.nodes.empty()) return best;
    struct Item {
        double gap; ///< no pair of leaves below is nearer
        std::uint32_t a, b;
        Vec3 centreB;
        bool operator<(const Item& other) const { return gap > other.gap; }
    };
    const auto gapOf = [&](std::uint32_t ia, std::uint32_t ib, const Vec3& centreB) {
        return (a.nodes[ia].centre - centreB).norm() - a.nodes[ia].radius - b.nodes[ib].radius;
    };
    // |c - C| + r <= R for a leaf (c, r) inside a node (C, R), hence no two leaves have a smaller gap than
    // their nodes have, also where that is negative.
    std::priority_queue<Item> queue;
    const Vec3 root = pose * b.nodes[0].centre;
    queue.push({gapOf(0, 0, root), 0, 0, root});
    while (!queue.empty() && queue.top().gap < best) {
        const Item item = queue.top();
        queue.pop();
        if (a.nodes[item.a].count == 0 && b.nodes[item.b].count == 0) {
            best = item.gap;
            break;
        }
        openLarger(a, b, item.a, item.b, [&](std::uint32_t ia, std::uint32_t ib) {
            const Vec3 centreB = ib == item.b ? item.centreB : Vec3(pose * b.nodes[ib].centre);
            const double gap = gapOf(ia, ib, centreB);
            if (gap < best) queue.push({gap, ia, ib, centreB});
            return false;
        });
    }
    return best;
}

} // namespace tss::compare
