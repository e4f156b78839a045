#include "bake/spheres/SphereQuery.h"

#include <algorithm>
#include <cmath>

namespace tss {

SphereQuery::SphereQuery(std::span<const Sphere> spheres) : spheres_(spheres.begin(), spheres.end()) {
    std::vector<Eigen::AlignedBox3d> boxes;
    boxes.reserve(spheres.size());
    for (const Sphere& s : spheres)
        boxes.emplace_back(s.centre - Vec3::Constant(s.radius), s.centre + Vec3::Constant(s.radius));
    bvh_ = buildBvh(boxes, 2);
    centres_.resize(bvh_.nodes.size());
    largest_.resize(bvh_.nodes.size(), 0);
    for (std::size_t n = bvh_.nodes.size(); n-- > 0;) {
        const Bvh::Node& node = bvh_.nodes[n];
        for (std::uint32_t i = 0; i < node.count; ++i) {
            const Sphere& s = spheres_[bvh_.items[node.first + i]];
            centres_[n].extend(s.centre);
            largest_[n] = std::max(largest_[n], s.radius);
        }
        if (node.count > 0) continue;
        for (const std::uint32_t child : {node.first, node.first + 1}) {
            centres_[n].extend(centres_[child]);
            largest_[n] = std::max(largest_[n], largest_[child]);
        }
    }
}

double SphereQuery::lowerBound(std::uint32_t node, const Vec3& x) const {
    const double box2 = squaredDistance(bvh_.nodes[node], x);
    if (box2 > 0) return std::sqrt(box2);
    return std::sqrt(centres_[node].squaredExteriorDistance(x)) - largest_[node];
}

SphereQuery::Nearest SphereQuery::nearest(const Vec3& x, double enough) const {
    Nearest best;
    std::array<std::pair<double, std::uint32_t>, 128> stack;
    std::size_t top = 0;
    if (!bvh_.empty()) stack[top++] = {lowerBound(0, x), 0};
    while (top > 0) {
        const auto [gap, index] = stack[--top];
        if (gap >= best.gap) continue;
        const Bvh::Node& node = bvh_.nodes[index];
        for (std::uint32_t i = 0; i < node.count; ++i) {
            const std::uint32_t s = bvh_.items[node.first + i];
            const double g = (x - spheres_[s].centre).norm() - spheres_[s].radius;
            if (g < best.gap) best = {g, static_cast<int>(s)};
        }
        if (best.gap <= enough) break;
        if (node.count > 0) continue;
        std::pair<double, std::uint32_t> near{lowerBound(node.first, x), node.first};
        std::pair<double, std::uint32_t> far{lowerBound(node.first + 1, x), node.first + 1};
        if (far.first < near.first) std::swap(near, far);
        if (far.first < best.gap) stack[top++] = far;
        if (near.first < best.gap) stack[top++] = near;
    }
    return best;
}

bool SphereQuery::contains(const Vec3& x) const {
    return nearest(x, 0).gap <= 0;
}

} // namespace tss
