#include "bake/search/AtRest.h"

#include "bake/search/TreePair.h"

#include <algorithm>
#include <limits>

namespace tss {

std::vector<RestPair> restOverlaps(const SphereSet& a, const SphereSet& b, const Motion& motion) {
    std::vector<RestPair> found;
    const std::vector<double> rest = restValues(motion);
    visitPairsWithin(SphereTree(a), SphereTree(b), pose(motion, rest), 0,
                     [&](std::uint32_t i, std::uint32_t j, double gap) {
                         if (gap < 0) found.push_back({{i, j}, gap - 1e-6 * (a[i].radius + b[j].radius)});
                     });
    std::sort(found.begin(), found.end(), [](const auto& x, const auto& y) { return x.pair < y.pair; });
    return found;
}

const RestPair* findRestPair(const std::vector<RestPair>& sorted, SpherePair pair) {
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), pair,
                                     [](const RestPair& x, const SpherePair& p) { return x.pair < p; });
    return at != sorted.end() && at->pair == pair ? &*at : nullptr;
}

double ContactRule::threshold(SpherePair pair) const {
    if (mode_ == AtRest::Collide || atRest_.empty()) return 0;
    const RestPair* rest = findRestPair(atRest_, pair);
    if (!rest) return 0;
    return mode_ == AtRest::Offset ? rest->gap : -std::numeric_limits<double>::infinity();
}

std::vector<double> ContactRule::thresholds(const std::vector<SpherePair>& pairs) const {
    std::vector<double> all;
    all.reserve(pairs.size());
    for (const SpherePair& pair : pairs) all.push_back(threshold(pair));
    if (std::all_of(all.begin(), all.end(), [](double t) { return t == 0; })) all.clear();
    return all;
}

} // namespace tss
