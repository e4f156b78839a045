#pragma once
#include "bake/base/Progress.h"
#include "bake/search/CandidatePairs.h"
#include "bake/search/SampledSearch.h"
#include "bake/table/Table.h"

namespace tss {

/// A reduced list of sphere pairs (the paper's Msm or Mss), ready for makeTable().
struct Reduced {
    std::vector<SpherePair> pairs; ///< sorted; indices into the whole sphere sets
    std::vector<double> restGaps;  ///< one per pair, or empty: all 0
    double lowerBound = 0;         ///< no list with the same answers is shorter than this; 0: none is known
};

/// The paper's reduction of a rigid pair (METHOD 3.1), Tc -> Msm. The co-occurrence table Ta counts in how
/// many rows of Tc (spheres of A) two spheres of B appear together; a sphere of B that never appears without
/// another one that is kept is removed, then of the rows of A with the same spheres of B the first is kept.
/// Which spheres meet counts, not at which poses: contact at some poses can be lost.
Reduced reduceCooccurrence(const CandidatePairs& candidates);

/// The minimal subset over explored poses (METHOD 3.2), the paper's Mss: as few pairs as can be found that
/// still collide at every explored pose where the whole sphere sets do. lowerBound: no such list is shorter.
/// The poses are those of searchSampled() with the same options. Nothing is said about poses between them.
Reduced reduceMinimal(const SphereSet& a, const SphereSet& b, const Motion& motion,
                      const SampledSearchOptions& options = {}, const Progress& progress = {});

} // namespace tss
