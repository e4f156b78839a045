#pragma once
#include "bake/base/Progress.h"
#include "bake/search/CandidatePairs.h"

namespace tss {

struct SampledSearchOptions {
    std::size_t samples = 4096; ///< poses to look at, over all DOFs; see exploredPoses()
    std::uint64_t seed = 1;
    ContactRule rule; ///< of these spheres
};

/// Tc as the paper finds it: every sphere pair that collides at one of the explored poses (METHOD 2.1). What
/// lies between the poses is not seen. Stopped early by progress, it has what was found by then.
CandidatePairs searchSampled(const SphereSet& a, const SphereSet& b, const Motion& motion,
                             const SampledSearchOptions& options = {}, const Progress& progress = {});

} // namespace tss
