#pragma once
#include "bake/pipeline/RestRule.h"
#include "bake/search/CandidatePairs.h"
#include "bake/search/SampledSearch.h"

namespace tss {

/// The input of search, selection and bounds for one pair.
struct PairTask {
    const PairSpheres& spheres;
    const Motion& motion;
    const BakeOptions& options;
    RuleAtRest ruled;
    double margin = 0; ///< pairs of spheres whose gap gets this small are of interest, scene units, >= 0
};

/// The task for spheres from fillPair(). The margin is the sum of both coverages, so that a table's own gap
/// is no larger than it wherever the meshes meet (METHOD 3.5); 0 where the coverage is not bounded.
PairTask pairTask(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options);

/// The pairs of spheres that can meet, or come within the margin (METHOD 2).
CandidatePairs searchPair(const PairTask& task, const Progress& progress);

/// The poses that the paper's search and reductions look at.
SampledSearchOptions sampledSearch(const PairTask& task);

/// Whether the list is what the search asked for finds; a certified search that ran out of effort is not.
bool allListed(const CandidatePairs& candidates, const BakeOptions& options);

} // namespace tss
