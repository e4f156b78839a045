#pragma once
#include "bake/motion/Motion.h"
#include "bake/spheres/SphereSet.h"
#include "bake/table/Table.h"

namespace tss {

/// What to do with sphere pairs that overlap at rest, as jointed parts often do (METHOD 2.4).
enum class AtRest {
    Offset,  ///< contact begins when they go deeper than they are at rest
    Ignore,  ///< they are left out
    Collide, ///< no exception
};

/// A sphere pair that overlaps in the rest pose and the threshold that replaces a gap of 0 for it.
struct RestPair {
    SpherePair pair;
    double gap = 0; ///< < 0, scene units: its gap at rest less a slack of 1e-6 of the radii, so that rounding
                    ///< does not make it touch at rest
};

/// The sphere pairs that overlap with the DOFs at their rest values, sorted by pair. Touching without
/// overlap is no overlap.
std::vector<RestPair> restOverlaps(const SphereSet& a, const SphereSet& b, const Motion& motion);

/// The entry of a pair in a list that restOverlaps() made, or null.
const RestPair* findRestPair(const std::vector<RestPair>& sorted, SpherePair pair);

/// When a sphere pair counts as in contact.
class ContactRule {
public:
    ContactRule(const SphereSet& a, const SphereSet& b, const Motion& motion, AtRest mode)
        : mode_(mode), atRest_(restOverlaps(a, b, motion)) {}

    const std::vector<RestPair>& atRest() const { return atRest_; }
    AtRest mode() const { return mode_; }

    /// The gap at which contact begins: 0, or the negative gap at rest. Ignored pairs: -infinity.
    double threshold(SpherePair pair) const;
    bool touches(SpherePair pair, double gap) const { return gap <= 0 && gap <= threshold(pair); }

    /// Thresholds of a list of pairs; empty when all are 0.
    std::vector<double> thresholds(const std::vector<SpherePair>& pairs) const;

private:
    AtRest mode_;
    std::vector<RestPair> atRest_;
};

} // namespace tss
