#pragma once
#include "bake/table/Table.h"

namespace tss {

/// A reduced list of sphere pairs, ready for makeTable(), and how large it is.
struct Reduced {
    std::vector<SpherePair> pairs; ///< sorted; indices into the whole sphere sets
    std::vector<double> restGaps;  ///< one per pair, or empty: all 0
    std::size_t spheresA = 0;      ///< spheres of A still used (the paper's Msm or Mss)
    std::size_t spheresB = 0;
    double lowerBound = 0; ///< no list with the same answers is shorter than this; 0: none is known
};

} // namespace tss
