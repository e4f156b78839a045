#include "bake/reduce/CoverProblem.h"

namespace tss {

namespace {

/// For every sphere another of the set that contains it whole (of equal ones the first), or -1.
std::vector<std::int32_t> holders(const SphereSet& set, const SphereTree& tree) {
    std::vector<std::int32_t> holder(set.size(), -1);
    for (std::uint32_t i = 0; i < set.size(); ++i) {
        std::vector<std::uint32_t> stack{0};
        while (!stack.empty() && holder[i] < 0) {
            const SphereTree::Node& node = tree[stack.back()];
            const std::uint32_t self = stack.back();
            stack.pop_back();
            const double distance = (node.centre - set[i].centre).norm();
            if (distance + set[i].radius > node.radius * (1 + 1e-12)) continue;
            if (!node.leaf()) {
                stack.push_back(node.right);
                stack.push_back(self + 1);
            } else if (const double larger = node.radius - set[i].radius;
                       node.sphere != i && distance <= larger && (larger > 0 || node.sphere < i)) {
                holder[i] = static_cast<std::int32_t>(node.sphere);
            }
        }
    }
    return holder;
}

} // namespace

CoverProblem::CoverProblem(const SphereSet& a, const SphereSet& b, const Motion& motion,
                           const ContactRule& rule, const std::vector<SpherePair>* candidates)
    : a(a), b(b), motion(motion), rule(rule), rates(motion), treeA(a), treeB(b) {
    wholeBox(motion); // refuses chains that are too long
    if (a.empty() || b.empty()) return;
    size = treeA[0].radius + treeB[0].radius;
    band = coordinateRounding(motion, treeA.extent(), treeB.extent());
    floor = std::max(1e-8 * size, 100 * band);
    holderA_ = holders(a, treeA);
    holderB_ = holders(b, treeB);
    if (!candidates) return;
    candidates_ = std::make_unique<ConcurrentPairs>(a.size(), b.size());
    for (const SpherePair& pair : *candidates) candidates_->insert(pair);
}

std::optional<ContactPair> CoverProblem::contactPair(SpherePair pair) const {
    if (!counts(pair)) return std::nullopt;
    const double contactDistance = a[pair.a].radius + b[pair.b].radius + rule.threshold(pair);
    if (!(contactDistance >= 0)) return std::nullopt;
    return ContactPair{pair, contactDistance};
}

std::optional<ContactPair> CoverProblem::requiredPair(SpherePair pair) const {
    const std::optional<ContactPair> required = contactPair(pair);
    if (!required) return std::nullopt;
    const auto held = [&](SpherePair by) { return counts(by) && rule.threshold(by) == 0; };
    if (holderA_[pair.a] >= 0 && held({static_cast<std::uint32_t>(holderA_[pair.a]), pair.b}))
        return std::nullopt;
    if (holderB_[pair.b] >= 0 && held({pair.a, static_cast<std::uint32_t>(holderB_[pair.b])}))
        return std::nullopt;
    return required;
}

} // namespace tss
