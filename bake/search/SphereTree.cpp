#include "bake/search/SphereTree.h"

#include "bake/base/Order.h"
#include "bake/geometry/Bvh.h"

#include <algorithm>

namespace tss {

SphereTree::SphereTree(const SphereSet& spheres, const std::function<bool()>& stop) {
    if (spheres.empty()) return;
    nodes_.reserve(2 * spheres.size() - 1);
    std::vector<std::uint32_t> order = indicesOf(spheres.size());
    if (!build(spheres, order, 0, order.size(), stop)) {
        nodes_.clear();
        return;
    }
    leaves_.resize(spheres.size());
    for (std::uint32_t n = 0; n < nodes_.size(); ++n)
        if (nodes_[n].leaf()) leaves_[nodes_[n].sphere] = n;
}

/// False: asked to stop.
bool SphereTree::build(const SphereSet& spheres, std::vector<std::uint32_t>& order, std::size_t first,
                       std::size_t last, const std::function<bool()>& stop) {
    if (stop && stop()) return false;
    const std::size_t self = nodes_.size();
    nodes_.emplace_back();
    if (last - first == 1) {
        const Sphere& s = spheres[order[first]];
        nodes_[self] = {s.centre, s.radius, 0, order[first]};
        return true;
    }
    const std::size_t middle = first + (last - first) / 2;
    const Eigen::AlignedBox3d box =
        partAlongLongest({order.begin() + first, order.begin() + last}, middle - first,
                         [&](std::uint32_t i) { return spheres[i].centre; });
    if (!build(spheres, order, first, middle, stop)) return false;
    const std::size_t right = nodes_.size();
    if (!build(spheres, order, middle, last, stop)) return false;

    // The smaller of two balls: that around the children's, which becomes too large higher up the tree, and
    // that about the middle of the box.
    Node& node = nodes_[self];
    node.right = static_cast<std::uint32_t>(right);
    const Node &low = nodes_[self + 1], &high = nodes_[right];
    const Sphere around = ballAround({low.centre, low.radius}, {high.centre, high.radius});
    node.centre = around.centre;
    node.radius = around.radius;
    const Vec3 centre = box.center();
    double radius = 0;
    for (std::size_t k = first; k < last; ++k)
        radius = std::max(radius, (spheres[order[k]].centre - centre).norm() + spheres[order[k]].radius);
    if (radius < node.radius) {
        node.centre = centre;
        node.radius = radius;
    }
    // A few units in the last place, so that rounding cannot leave a sphere sticking out.
    node.radius += 1e-15 * (node.radius + node.centre.norm());
    return true;
}

} // namespace tss
