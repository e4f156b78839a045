#pragma once
#include "bake/base/Progress.h"
#include "bake/reduce/Reductions.h"
#include "bake/search/CandidatePairs.h"

namespace tss {

/// Over more DOFs no cover is looked for.
inline constexpr std::size_t mostCoverDofs = 6;

struct CoverOptions {
    double epsilon = 0;   ///< how far the table's gap may exceed that of all pairs, scene units; 0: lossless
    double gapDepth = 0;  ///< gap-true down to this depth (METHOD 3.4) ...
    double gapMargin = 0; ///< ... and up to this clearance; both 0: a yes/no table
    ContactRule rule;     ///< of these spheres
    double seconds = 0;   ///< time budget, 0: none. A search ended by time may differ from run to run
    std::uint64_t looks = 0; ///< budget in looks at pairs, 0: none. The same result every time
    /// Where a budget ends, prove the smallest larger epsilon that can be. False: prove nothing, the epsilon
    /// reached is infinity, and that comes soon where the budget would not suffice.
    bool coarser = true;
};

/// A cover and what is proven about it.
struct CoverResult : Reduced {
    /// At every pose of Q where the sphere models' gap is <= gapMargin, the gap of the pairs is
    /// <= max(gap of the models, -gapDepth) + epsilon. What was reached, whether or not it is what was asked
    /// for; infinite when nothing is proven.
    double epsilon = 0;
    bool complete = false;   ///< epsilon is not larger than the one asked for
    double clearance = 0;    ///< no pairs: the sphere models stay farther apart than this (METHOD 2.3)
    std::uint64_t cells = 0; ///< cells of Q looked at, all steps together
    std::uint64_t looks = 0; ///< at pairs of spheres and of nodes in them
    std::size_t forced = 0; ///< pairs taken in cells too small to split, without a pose that shows their need
};

/// The smallest list of pairs found that answers like all of them, for every pose of Q and not for samples
/// (METHOD 3.3, 3.4). candidates null: all pairs of the two sets, found from the two sphere trees. With
/// candidates the answer is about those pairs alone. No pairs in a complete result: a proof that the models
/// never collide. lowerBound is what every such list needs. Throws InputError for more than mostCoverDofs
/// DOFs.
CoverResult certifiedCover(const SphereSet& a, const SphereSet& b, const CandidatePairs* candidates,
                           const Motion& motion, const CoverOptions& options = {},
                           const Progress& progress = {});

} // namespace tss
