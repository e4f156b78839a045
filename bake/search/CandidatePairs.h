#pragma once
#include "bake/search/AtRest.h"
#include "bake/table/Table.h"

namespace tss {

/// Which sphere pairs can collide somewhere in Q: the paper's collision table Tc (METHOD 2).
struct CandidatePairs {
    std::vector<SpherePair> pairs; ///< sorted; indices into the whole sphere sets
    std::vector<double> restGaps;  ///< per pair: the gap at which contact begins, scene units: 0, or less
                                   ///< where it is excepted at rest (METHOD 2.4); empty: all 0

    bool certified = false;     ///< complete over all of Q, not over samples
    double clearance = 0;       ///< certified and no pairs: the sphere models stay farther apart than this
    std::uint64_t explored = 0; ///< poses (sampled) or cells of Q (certified) looked at
};

} // namespace tss
