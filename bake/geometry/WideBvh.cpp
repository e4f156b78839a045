#include "bake/geometry/WideBvh.h"

namespace tss {

WideBvh::WideBvh(const Bvh& bvh, std::span<const Vec3> normals) : items_(bvh.items) {
    if (bvh.empty()) return;
    std::vector<Eigen::AlignedBox3d> below(bvh.nodes.size());
    for (std::size_t i = below.size(); i-- > 0;) {
        const Bvh::Node& node = bvh.nodes[i];
        for (std::uint32_t k = 0; k < node.count; ++k) below[i].extend(normals[bvh.items[node.first + k]]);
        if (node.count == 0) below[i] = below[node.first].merged(below[node.first + 1]);
    }
    const Bvh::Node& root = bvh.nodes.front();
    centre_ = (root.lower + root.upper) / 2;
    size_ = static_cast<float>((root.upper - root.lower).maxCoeff() / 2);
    add(bvh, 0, below);
}

/// Makes one node of a Bvh node's grandchildren, or children that are leaves, and adds their subtrees.
/// Returns its index.
std::uint32_t WideBvh::add(const Bvh& bvh, std::uint32_t index,
                           std::span<const Eigen::AlignedBox3d> normals) {
    std::array<std::uint32_t, 4> below{index};
    std::size_t count = 1;
    for (int level = 0; level < 2; ++level) {
        const std::array<std::uint32_t, 4> above = below;
        for (std::size_t c = 0, before = std::exchange(count, 0); c < before; ++c) {
            const Bvh::Node& child = bvh.nodes[above[c]];
            below[count++] = child.count > 0 ? above[c] : child.first;
            if (child.count == 0) below[count++] = child.first + 1;
        }
    }
    constexpr float nowhere = 1e18f; // its square is still a float
    const auto place = static_cast<std::uint32_t>(nodes_.size());
    Node& node = nodes_.emplace_back();
    for (int k = 0; k < 3; ++k) node.lower[k] = node.upper[k] = Four::Constant(nowhere);
    for (int k = 0; k < 3; ++k) node.least[k] = node.most[k] = Four::Zero();
    for (std::size_t c = 0; c < count; ++c) {
        const Bvh::Node& child = bvh.nodes[below[c]];
        const auto lane = static_cast<Eigen::Index>(c);
        for (int k = 0; k < 3; ++k) {
            node.lower[k][lane] = static_cast<float>(child.lower[k] - centre_[k]);
            node.upper[k][lane] = static_cast<float>(child.upper[k] - centre_[k]);
            node.least[k][lane] = static_cast<float>(normals[below[c]].min()[k]);
            node.most[k][lane] = static_cast<float>(normals[below[c]].max()[k]);
        }
        node.first[c] = child.first;
        node.count[c] = child.count;
    }
    for (std::size_t c = 0; c < count; ++c)
        if (bvh.nodes[below[c]].count == 0) {
            const std::uint32_t child = add(bvh, below[c], normals);
            nodes_[place].first[c] = child;
        }
    return place;
}

} // namespace tss
