#pragma once
#include "bake/reduce/CertifiedCover.h"
#include "bake/reduce/CoverProblem.h"
#include "bake/search/PairDistanceBounds.h"

namespace tss {

/// A pair at the centre pose of a cell, with bounds of its distance all over the cell.
struct PairInCell : PairDistanceBounds<mostCoverDofs> {
    ContactPair contactPair;
    std::uint32_t member = 0; ///< its number in the cover, where it is a member
    double gap;               ///< at the cell's centre pose, scene units

    PairInCell(const CellMotion& cell, const Vec3& x, const CellMotion::PointMotion& moved,
               const Vec3& centreA, const ContactPair& p)
        : PairDistanceBounds<mostCoverDofs>(cell, x, moved, centreA), contactPair(p),
          gap(distance - p.contactDistance) {}
};

/// Whether k answers wherever p needs an answer, at every pose of the cell (METHOD 3.3, domination by
/// difference). Shown with squared distances: the difference of two of them is nearly linear for neighbouring
/// pairs, so that cells stay large. A member k answers with the contract's epsilon; for a k that is no member
/// pass a contract with epsilon 0. band: rounding error of distances, scene units.
bool dominates(const CellMotion& cell, const PairInCell& k, const PairInCell& p,
               const ErrorContract& contract, double band);

/// A cheap necessary condition: k cannot dominate p unless answerRank(k) < rankNeeded(p).
double answerRank(const PairInCell& k, const ErrorContract& contract);
double rankNeeded(const PairInCell& p, const ErrorContract& contract);

} // namespace tss
