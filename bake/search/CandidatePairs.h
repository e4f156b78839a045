#pragma once
#include "bake/search/AtRest.h"
#include "bake/table/Table.h"

namespace tss {

/// Which sphere pairs can collide somewhere in Q: the paper's collision table Tc (METHOD 2).
struct CandidatePairs {
    std::vector<SpherePair> pairs; ///< sorted; indices into the whole sphere sets
    std::vector<double> restGaps;  ///< one per pair (METHOD 2.4), or empty: all 0
    std::size_t spheresA = 0;      ///< spheres of A in some pair (the paper's Msc of A)
    std::size_t spheresB = 0;      ///< spheres of B in some pair (Msc of B)

    bool certified = false;      ///< complete over all of Q, not over samples
    double clearance = 0;        ///< certified and no pairs: the sphere models stay farther apart than this
    std::uint64_t explored = 0;  ///< poses (sampled) or cells of Q (certified) looked at
    std::uint64_t colliding = 0; ///< poses at which some pair collides (sampled)
};

/// Fills spheresA and spheresB from the pairs.
void countSpheres(CandidatePairs& candidates);

} // namespace tss
