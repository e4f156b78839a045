#pragma once
#include "bake/motion/Motion.h"
#include "bake/search/SphereTree.h"

#include <type_traits>
#include <utility>
#include <vector>

namespace tss {

/// Calls visit(i, j, gap) for every sphere i of A and j of B whose gap at the pose is <= reach (the gap as it
/// is calculated: none is lost to the rounding of the balls about it), in an order that depends on the trees
/// alone. A visit that returns false is the last one; it may return nothing.
template <typename Visit>
void visitPairsWithin(const SphereTree& a, const SphereTree& b, const Pose& pose, double reach,
                      Visit&& visit) {
    if (a.empty() || b.empty()) return;
    struct Item {
        std::uint32_t a, b;
        Vec3 centreB; ///< of node b, in A's frame
    };
    const double rounding = 0x1p-48 * (a.extent() + b.extent() + pose.translation().norm());
    std::vector<Item> stack{{0, 0, pose * b[0].centre}};
    while (!stack.empty()) {
        const Item item = stack.back();
        stack.pop_back();
        const SphereTree::Node &na = a[item.a], &nb = b[item.b];
        const double sum = na.radius + nb.radius;
        const double limit = sum + reach + rounding;
        if (limit < 0) continue;
        const double squared = (item.centreB - na.centre).squaredNorm();
        if (squared > limit * limit) continue;
        if (na.leaf() && nb.leaf()) {
            const double gap = std::sqrt(squared) - sum;
            if (gap > reach) continue;
            if constexpr (std::is_void_v<decltype(visit(na.sphere, nb.sphere, gap))>)
                visit(na.sphere, nb.sphere, gap);
            else if (!visit(na.sphere, nb.sphere, gap))
                return;
        } else if (!na.leaf() && (nb.leaf() || na.radius >= nb.radius)) {
            stack.push_back({na.right, item.b, item.centreB});
            stack.push_back({item.a + 1, item.b, item.centreB});
        } else {
            stack.push_back({item.a, nb.right, pose * b[nb.right].centre});
            stack.push_back({item.a, item.b + 1, pose * b[item.b + 1].centre});
        }
    }
}

/// The smallest gap over all pairs at the pose, or `atMost` when none is smaller.
inline double smallestGap(const SphereTree& a, const SphereTree& b, const Pose& pose, double atMost) {
    if (a.empty() || b.empty()) return atMost;
    struct Item {
        std::uint32_t a, b;
        double lower; ///< no pair below has a smaller gap
    };
    const auto item = [&](std::uint32_t na, std::uint32_t nb) {
        return Item{na, nb, (pose * b[nb].centre - a[na].centre).norm() - a[na].radius - b[nb].radius};
    };
    std::vector<Item> stack{item(0, 0)};
    while (!stack.empty()) {
        const Item at = stack.back();
        stack.pop_back();
        if (at.lower >= atMost) continue;
        const SphereTree::Node &na = a[at.a], &nb = b[at.b];
        if (na.leaf() && nb.leaf()) {
            atMost = at.lower;
            continue;
        }
        const bool openA = !na.leaf() && (nb.leaf() || na.radius >= nb.radius);
        Item near = openA ? item(at.a + 1, at.b) : item(at.a, at.b + 1);
        Item far = openA ? item(na.right, at.b) : item(at.a, nb.right);
        if (near.lower > far.lower) std::swap(near, far);
        stack.push_back(far);
        stack.push_back(near);
    }
    return atMost;
}

} // namespace tss
