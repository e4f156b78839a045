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
    std::vector<std::uint32_t> below{index};
    for (int level = 0; level < 2; ++level) {
        std::vector<std::uint32_t> next;
        for (const std::uint32_t child : below) {
            next.push_back(child);
            if (bvh.nodes[child].count > 0) continue;
            next.back() = bvh.nodes[child].first;
            next.push_back(bvh.nodes[child].first + 1);
        }
        below.swap(next);
    }
    constexpr float nowhere = 1e18f; // its square is still a float
    const auto place = static_cast<std::uint32_t>(nodes_.size());
    Node& node = nodes_.emplace_back();
    for (int k = 0; k < 3; ++k) node.lower[k] = node.upper[k] = Four::Constant(nowhere);
    for (int k = 0; k < 3; ++k) node.least[k] = node.most[k] = Four::Zero();
    for (std::size_t c = 0; c < below.size(); ++c) {
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
    for (std::size_t c = 0; c < below.size(); ++c)
        if (bvh.nodes[below[c]].count == 0) {
            const std::uint32_t child = add(bvh, below[c], normals);
            nodes_[place].first[c] = child;
        }
    return place;
}

} // namespace tss
