#pragma once
#include "bake/base/Progress.h"
#include "bake/search/CandidatePairs.h"
#include "bake/search/SampledSearch.h"
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

/// The paper's reduction of a rigid pair (METHOD 3.1), Tc -> Msm. The co-occurrence table Ta counts in how
/// many rows of Tc (spheres of A) two spheres of B appear together; a sphere of B that never appears without
/// some kept other is removed, then rows of A that test the same spheres of B become one (the first stays).
/// It looks at who meets whom, not at when: poses can be lost.
Reduced reduceCooccurrence(const CandidatePairs& candidates);

/// The minimal subset over explored poses (METHOD 3.2), the paper's Mss: as few pairs as can be found that
/// still collide at every explored pose where the whole sphere sets do. lowerBound: what any such list needs.
/// The poses are those of searchSampled() with the same options. Nothing is said about poses between them.
Reduced reduceMinimal(const SphereSet& a, const SphereSet& b, const Motion& motion,
                      const SampledSearchOptions& options = {}, const Progress& progress = {});

} // namespace tss
