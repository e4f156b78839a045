#pragma once
#include "bake/spheres/SphereSet.h"

#include <cstdint>
#include <functional>

namespace tss {

/// A binary tree of balls over a sphere set: each node's ball holds the spheres below it whole. Balls stay
/// balls under a rigid motion, so one tree serves every pose.
class SphereTree {
public:
    struct Node {
        Vec3 centre = Vec3::Zero();
        double radius = 0;
        std::uint32_t right = 0;  ///< the left child follows its parent; 0: this is a leaf
        std::uint32_t sphere = 0; ///< index in the set (leaf)
        bool leaf() const { return right == 0; }
    };

    /// stop: asked at each node; once it says true, the tree is empty.
    explicit SphereTree(const SphereSet& spheres, const std::function<bool()>& stop = {});

    bool empty() const { return nodes_.empty(); }
    /// No point of a sphere is farther from the origin; 0 of an empty tree.
    double extent() const { return empty() ? 0 : nodes_[0].centre.norm() + nodes_[0].radius; }
    const Node& operator[](std::uint32_t i) const { return nodes_[i]; }
    std::size_t size() const { return nodes_.size(); } ///< 2 #spheres - 1; the root is node 0
    std::uint32_t leafOf(std::uint32_t sphere) const { return leaves_[sphere]; }

private:
    bool build(const SphereSet& spheres, std::vector<std::uint32_t>& order, std::size_t first,
               std::size_t last, const std::function<bool()>& stop);
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaves_;
};

} // namespace tss
