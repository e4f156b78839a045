#pragma once
#include "bake/reduce/CoverProblem.h"
#include "bake/search/PairAt.h"

namespace tss {

/// A pair at the centre of a cell, with what it needs to be weighed against others there.
struct PairHere : PairAt {
    ReachPair reachPair;
    std::uint32_t member = 0; ///< its number in the cover, for a member
    double gap;               ///< at the cell's centre

    PairHere(const CellMotion& cell, const Vec3& x, const CellMotion::Reach& reach, const Vec3& centreA,
             const ReachPair& p)
        : PairAt(cell, x, reach, centreA), reachPair(p), gap(distance - p.reach) {}
};

/// All over the cell: wherever p owes an answer, k gives it (METHOD 3.3, domination by difference). Worked
/// out on squared distances: the difference of two of them is nearly linear, as neighbours curve alike, so
/// that cells stay large. A member k answers with the obligation's epsilon; for a k that is no member pass
/// epsilon 0. band: rounding error of distances.
bool dominates(const CellMotion& cell, const PairHere& k, const PairHere& p, const Obligation& owed,
               double band);

/// A quick look before it: k cannot dominate p unless answerRank(k) < rankNeeded(p).
double answerRank(const PairHere& k, const Obligation& owed);
double rankNeeded(const PairHere& p, const Obligation& owed);

} // namespace tss
