#pragma once
#include "bake/reduce/CoverProblem.h"
#include "bake/search/PairDistanceBounds.h"

namespace tss {

/// A pair at the centre of a cell, with what it needs to be weighed against others there.
struct PairInCell : PairDistanceBounds {
    ContactPair contactPair;
    std::uint32_t member = 0; ///< its number in the cover, for a member
    double gap;               ///< at the cell's centre

    PairInCell(const CellMotion& cell, const Vec3& x, const CellMotion::PointMotion& moved,
               const Vec3& centreA, const ContactPair& p)
        : PairDistanceBounds(cell, x, moved, centreA), contactPair(p), gap(distance - p.contactDistance) {}
};

/// All over the cell: wherever p owes an answer, k gives it (METHOD 3.3, domination by difference). Worked
/// out on squared distances: the difference of two of them is nearly linear, as neighbours curve alike, so
/// that cells stay large. A member k answers with the contract's epsilon; for a k that is no member pass
/// epsilon 0. band: rounding error of distances.
bool dominates(const CellMotion& cell, const PairInCell& k, const PairInCell& p, const ErrorContract& owed,
               double band);

/// A quick look before it: k cannot dominate p unless answerRank(k) < rankNeeded(p).
double answerRank(const PairInCell& k, const ErrorContract& owed);
double rankNeeded(const PairInCell& p, const ErrorContract& owed);

} // namespace tss
