#include "bake/search/CandidatePairs.h"

#include <set>

namespace tss {

void countSpheres(CandidatePairs& candidates) {
    std::set<std::uint32_t> a, b;
    for (const SpherePair& p : candidates.pairs) {
        a.insert(p.a);
        b.insert(p.b);
    }
    candidates.spheresA = a.size();
    candidates.spheresB = b.size();
}

} // namespace tss
