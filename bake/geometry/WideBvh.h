#pragma once
#include "bake/geometry/Bvh.h"

namespace tss {

/// A Bvh with up to four children a node, whose boxes are tested at once in a vector. Boxes are floats,
/// relative to the centre of the whole; every test is conservative by their rounding, so that it finds
/// whatever the doubles of the Bvh would.
class WideBvh {
public:
    WideBvh() = default;
    /// normals: of the items, unit or zero.
    WideBvh(const Bvh& bvh, std::span<const Vec3> normals);

    /// As visitNearest() of a Bvh. facing: subtrees in which no item's normal n has n . facing > 0 are
    /// skipped; zero: none is skipped.
    template <class Leaf>
    void visitNearest(const Vec3& p, double& best2, const Vec3& facing, Leaf&& leaf) const;

    /// Calls leaf(item) for items whose box the segment may pass through, until a call returns true. Returns
    /// whether one did.
    template <class Leaf>
    bool visitSegment(const Vec3& from, const Vec3& to, Leaf&& leaf) const;

private:
    using Four = Eigen::Array4f;
    struct Node {
        Four lower[3], upper[3];              ///< of each child's box, about centre_; far away for no child
        Four least[3], most[3];               ///< bounds of the normals in each child's subtree
        std::array<std::uint32_t, 4> first{}; ///< leaf: place in items_; inner node: the child
        std::array<std::uint32_t, 4> count{}; ///< of a leaf's items; 0: an inner node
    };
    /// Large enough: a Bvh is at most 100 levels deep, two of which make one here, with 3 siblings each.
    using Stack = std::array<std::pair<float, std::uint32_t>, 256>;
    /// Bound of the relative rounding error of a test, which has a few float operations.
    static constexpr float slack = 1e-6f;

    std::uint32_t add(const Bvh& bvh, std::uint32_t index, std::span<const Eigen::AlignedBox3d> normals);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> items_;
    Vec3 centre_ = Vec3::Zero();
    float size_ = 0; ///< largest absolute coordinate of a box about centre_
};

template <class Leaf>
void WideBvh::visitNearest(const Vec3& p, double& best2, const Vec3& facing, Leaf&& leaf) const {
    if (nodes_.empty()) return;
    const Eigen::Vector3f x = (p - centre_).cast<float>();
    const Eigen::Array3f off = Eigen::Array3f::Constant(slack * (x.cwiseAbs().maxCoeff() + size_));
    const Eigen::Array3f low = x.array() + off, high = x.array() - off;
    const bool any = facing.isZero(0);
    const Eigen::Array3f towards = facing.cast<float>();
    const float turnedAway = any ? -1 : -slack * towards.abs().sum();
    Stack stack;
    std::size_t top = 0;
    stack[top++] = {0.0f, 0};
    while (top > 0) {
        const auto [distance2, index] = stack[--top];
        if (static_cast<double>(distance2) >= best2) continue;
        const Node& node = nodes_[index];
        Four squared = Four::Zero(), along = Four::Zero();
        for (int k = 0; k < 3; ++k) {
            squared += (node.lower[k] - low[k]).max(high[k] - node.upper[k]).max(0.0f).square();
            along += (node.least[k] * towards[k]).max(node.most[k] * towards[k]);
        }
        squared *= 1 - slack;
        const std::size_t before = top;
        for (int c = 0; c < 4; ++c) {
            if (!(static_cast<double>(squared[c]) < best2) || along[c] < turnedAway) continue;
            if (node.count[c] > 0) {
                for (std::uint32_t i = 0; i < node.count[c]; ++i) leaf(items_[node.first[c] + i]);
                continue;
            }
            std::size_t place = top++; // the nearest on top
            for (; place > before && stack[place - 1].first < squared[c]; --place)
                stack[place] = stack[place - 1];
            stack[place] = {squared[c], node.first[c]};
        }
    }
}

template <class Leaf>
bool WideBvh::visitSegment(const Vec3& from, const Vec3& to, Leaf&& leaf) const {
    if (nodes_.empty()) return false;
    const Eigen::Array3f start = (from - centre_).cast<float>(), end = (to - centre_).cast<float>();
    const Eigen::Array3f off =
        Eigen::Array3f::Constant(slack * (start.abs().max(end.abs()).maxCoeff() + size_));
    constexpr float least = 1e-18f; // in place of 0 along an axis: cheaper than a case of its own
    const Eigen::Array3f way = end - start, perWay = (way.abs() < least).select(least, way).inverse();
    const Eigen::Array3f low = start + off, high = start - off;
    std::array<std::uint32_t, std::tuple_size_v<Stack>> stack;
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Node& node = nodes_[stack[--top]];
        Four first = Four::Zero(), last = Four::Ones();
        for (int k = 0; k < 3; ++k) {
            const Four s = (node.lower[k] - low[k]) * perWay[k], t = (node.upper[k] - high[k]) * perWay[k];
            first = first.max(s.min(t));
            last = last.min(s.max(t));
        }
        for (int c = 0; c < 4; ++c) {
            if (!(first[c] <= last[c])) continue;
            if (node.count[c] == 0) stack[top++] = node.first[c];
            for (std::uint32_t i = 0; i < node.count[c]; ++i)
                if (leaf(items_[node.first[c] + i])) return true;
        }
    }
    return false;
}

} // namespace tss
