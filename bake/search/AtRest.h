#pragma once
#include "bake/motion/Motion.h"
#include "bake/spheres/SphereSet.h"
#include "bake/table/Table.h"

namespace tss {

/// What to do with the region in which the meshes of jointed parts overlap at rest (METHOD 2.4).
enum class AtRest {
    Offset,  ///< it may go no deeper than it is at rest
    Ignore,  ///< it is left out
    Collide, ///< no exception
};

/// When a sphere pair counts as in contact: where its gap is 0. Excepted are pairs of which both spheres
/// stand for the region that overlaps at rest.
class ContactRule {
public:
    /// No exception.
    ContactRule() = default;

    /// regionA, regionB: for each sphere whether it stands for the region. depth: contact of such a pair
    /// begins when its spheres are deeper in each other than this, scene units; < 0: never.
    ContactRule(std::vector<char> regionA, std::vector<char> regionB, double depth);

    /// No pair is excepted.
    bool empty() const { return regionA_.empty(); }
    const std::vector<char>& regionA() const { return regionA_; }
    const std::vector<char>& regionB() const { return regionB_; }
    bool excepts(SpherePair pair) const { return !empty() && regionA_[pair.a] && regionB_[pair.b]; }

    /// The gap at which contact begins: 0; of excepted pairs -depth, or -infinity.
    double threshold(SpherePair pair) const { return excepts(pair) ? threshold_ : 0; }
    bool touches(SpherePair pair, double gap) const { return gap <= threshold(pair); }

    /// The one of all excepted pairs.
    double threshold() const { return threshold_; }

    /// Thresholds of a list of pairs; empty when all are 0.
    std::vector<double> thresholds(const std::vector<SpherePair>& pairs) const;

private:
    std::vector<char> regionA_, regionB_;
    double threshold_ = 0;
};

/// How deep the spheres of the regions are in each other with the DOFs at their rest values: the deepest pair
/// with a slack of 1e-6 of its radii, so that rounding does not make it touch there; 0 when none overlaps.
double depthAtRest(const SphereSet& a, const SphereSet& b, const Motion& motion,
                   const std::vector<char>& regionA, const std::vector<char>& regionB);

/// The rule where only spheres are known and no surfaces: each that overlaps one of the other body at rest
/// counts as of the region. Touching without overlap is no overlap.
ContactRule ruleOfSpheres(const SphereSet& a, const SphereSet& b, const Motion& motion, AtRest mode);

} // namespace tss
