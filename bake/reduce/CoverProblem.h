#pragma once
#include "bake/motion/MotionBound.h"
#include "bake/search/CandidatePairs.h"
#include "bake/search/SphereTree.h"

#include <memory>
#include <optional>

namespace tss {

/// What a table must guarantee (METHOD 3.3, 3.4): wherever the gap of the whole models is <= margin, the
/// table's gap is <= max(gap, -depth) + epsilon. All in scene units. depth = margin = 0: a yes/no table.
struct ErrorContract {
    double epsilon = 0, depth = 0, margin = 0;
    bool yesNo() const { return depth == 0 && margin == 0; }
    /// The largest gap of the table that is allowed where the models have this gap.
    double answer(double gap) const { return std::max(gap, -depth) + epsilon; }
};

/// A sphere pair with the distance of centres at which contact begins: the radii, less the overlap at rest.
struct ContactPair {
    SpherePair pair;
    double contactDistance = 0; ///< scene units
};

/// Everything about one cover that stays the same while it is searched: the models, the motion, which pairs
/// count. Read by many threads, written by none.
class CoverProblem {
public:
    /// candidates null: all pairs count.
    CoverProblem(const SphereSet& a, const SphereSet& b, const Motion& motion, const ContactRule& rule,
                 const std::vector<SpherePair>* candidates);

    const SphereSet &a, &b;
    const Motion& motion;
    const ContactRule& rule;
    MotionRates rates;
    SphereTree treeA, treeB;
    double size = 0;  ///< scene units: sum of the two models' radii, the unit of relative tolerances
    double band = 0;  ///< scene units: rounding error of distances
    double floor = 0; ///< scene units: cells in which points move less are not split further

    /// The pair with its distance at contact; nothing where no table may use it: it is no candidate, or
    /// exempt at every depth.
    std::optional<ContactPair> contactPair(SpherePair pair) const;

    /// The same, but also nothing for pairs that need no answer of their own, because one of the spheres lies
    /// inside another sphere whose pair counts.
    std::optional<ContactPair> requiredPair(SpherePair pair) const;

    /// The gap of a pair at a pose, counted from where its contact begins.
    double gap(const ContactPair& p, const Pose& pose) const {
        return (pose * b[p.pair.b].centre - a[p.pair.a].centre).norm() - p.contactDistance;
    }

private:
    bool counts(SpherePair pair) const { return !candidates_ || candidates_->contains(pair); }

    std::unique_ptr<ConcurrentPairs> candidates_;
    std::vector<std::int32_t> holderA_, holderB_; ///< #spheres: one that contains this one whole, or -1
};

} // namespace tss
