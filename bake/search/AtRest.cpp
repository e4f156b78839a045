#include "bake/search/AtRest.h"

#include "bake/search/NodePairs.h"

#include <algorithm>
#include <limits>

namespace tss {

ContactRule::ContactRule(std::vector<char> regionA, std::vector<char> regionB, double depth)
    : regionA_(std::move(regionA)), regionB_(std::move(regionB)),
      threshold_(depth < 0 ? -std::numeric_limits<double>::infinity() : -depth) {
    const auto any = [](const std::vector<char>& region) {
        return std::any_of(region.begin(), region.end(), [](char in) { return in != 0; });
    };
    if (any(regionA_) && any(regionB_)) return;
    regionA_.clear();
    regionB_.clear();
}

std::vector<double> ContactRule::thresholds(const std::vector<SpherePair>& pairs) const {
    if (std::none_of(pairs.begin(), pairs.end(), [&](const SpherePair& pair) { return excepts(pair); }))
        return {};
    std::vector<double> all;
    all.reserve(pairs.size());
    for (const SpherePair& pair : pairs) all.push_back(threshold(pair));
    return all;
}

namespace {

/// Calls visit(i, j, gap) for every pair that overlaps at rest.
template <typename Visit>
void visitOverlaps(const SphereSet& a, const SphereSet& b, const Motion& motion, Visit&& visit) {
    const std::vector<double> rest = restValues(motion);
    visitPairsWithin(SphereTree(a), SphereTree(b), pose(motion, rest), 0,
                     [&](std::uint32_t i, std::uint32_t j, double gap) {
                         if (gap < 0) visit(i, j, gap);
                     });
}

} // namespace

double depthAtRest(const SphereSet& a, const SphereSet& b, const Motion& motion,
                   const std::vector<char>& regionA, const std::vector<char>& regionB) {
    double deepest = 0;
    visitOverlaps(a, b, motion, [&](std::uint32_t i, std::uint32_t j, double gap) {
        if (regionA[i] && regionB[j]) deepest = std::max(deepest, -gap + 1e-6 * (a[i].radius + b[j].radius));
    });
    return deepest;
}

ContactRule ruleOfSpheres(const SphereSet& a, const SphereSet& b, const Motion& motion, AtRest mode) {
    if (mode == AtRest::Collide) return {};
    std::vector<char> regionA(a.size(), 0), regionB(b.size(), 0);
    visitOverlaps(a, b, motion,
                  [&](std::uint32_t i, std::uint32_t j, double) { regionA[i] = regionB[j] = 1; });
    const double depth = mode == AtRest::Offset ? depthAtRest(a, b, motion, regionA, regionB) : -1;
    return {std::move(regionA), std::move(regionB), depth};
}

} // namespace tss
