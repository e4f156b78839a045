#pragma once
#include "bake/motion/MotionBound.h"
#include "bake/search/CandidatePairs.h"
#include "bake/search/ConcurrentPairs.h"
#include "bake/search/SphereTree.h"

#include <memory>

namespace tss {

/// What a table owes the whole models (METHOD 3.3, 3.4): wherever their gap is <= margin, the table's gap is
/// <= max(gap, -depth) + epsilon. depth = margin = 0: a yes/no table.
struct ErrorContract {
    double epsilon = 0, depth = 0, margin = 0;
    bool yesNo() const { return depth == 0 && margin == 0; }
    /// The largest gap of the table that still answers a gap of the models.
    double answer(double gap) const { return std::max(gap, -depth) + epsilon; }
};

/// A sphere pair with the distance of centres at which contact begins: the radii, less the overlap at rest.
struct ContactPair {
    SpherePair pair;
    double contactDistance = 0;
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
    double size = 0;  ///< how far apart parts of the models can be: the unit of relative tolerances
    double band = 0;  ///< rounding error that distances may carry
    double floor = 0; ///< cells whose motion is smaller are not split further

    /// The pair with its distance at contact; nothing when it carries no contract: it is ignored at rest, not
    /// a candidate, or one of its spheres lies inside another that does the same.
    bool admit(SpherePair pair, ContactPair& out) const;

    /// The same, except that spheres inside others count too: whether a table may use the pair.
    bool countsAtAll(SpherePair pair, ContactPair& out) const;

    /// The gap of a pair at a pose, counted from where its contact begins.
    double gap(const ContactPair& p, const Pose& pose) const {
        return (pose * b[p.pair.b].centre - a[p.pair.a].centre).norm() - p.contactDistance;
    }

private:
    bool counts(SpherePair pair) const { return !candidates_ || candidates_->contains(pair); }

    std::unique_ptr<ConcurrentPairs> candidates_;
    std::vector<std::int32_t> holderA_, holderB_; ///< a sphere that holds this one whole, or -1
};

} // namespace tss
