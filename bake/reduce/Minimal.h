#pragma once
#include "bake/base/Progress.h"
#include "bake/reduce/Reduced.h"
#include "bake/search/SampledSearch.h"

namespace tss {

/// The minimal subset over explored poses (METHOD 3.2), the paper's Mss: as few pairs as can be found that
/// still collide at every explored pose where the whole sphere sets do. lowerBound: what any such list needs.
/// The poses are those of searchSampled() with the same options. Nothing is said about poses between them.
Reduced reduceMinimal(const SphereSet& a, const SphereSet& b, const Motion& motion,
                      const SampledSearchOptions& options = {}, const Progress& progress = {});

} // namespace tss
