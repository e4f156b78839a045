#pragma once
#include "bake/base/Progress.h"

#include <cstddef>
#include <functional>

namespace tss {

/// Searches the finest tolerance that needs at most `limit` spheres. count(tolerance): how many it takes,
/// about falling in the tolerance. Looks at most a dozen times, coarse ones first, and never finer than
/// `finest`; ends with a count within 3 % of the limit or a tolerance within 2 % of one that takes too many.
/// coarsest: a tolerance that one sphere reaches. Returns the finest tolerance that was seen to do.
double toleranceFor(std::size_t limit, double finest, double coarsest,
                    const std::function<std::size_t(double)>& count, const Progress& progress = {});

} // namespace tss
