#pragma once
#include "bake/base/Progress.h"
#include "bake/search/CandidatePairs.h"

namespace tss {

struct CertifiedSearchOptions {
    double margin = 0;     ///< pairs whose gap gets this small are wanted, scene units, >= 0
    double tolerance = -1; ///< tau: no pair is listed whose gap stays above margin + tau; < 0: a hundredth of
                           ///< the mean radius
    ContactRule rule;      ///< of these spheres
    bool measureClearance = true; ///< when nothing collides, find out how far apart the bodies stay
    /// The search gives up, not certified, after about so many looks at pairs of tree nodes (about a million
    /// a second and thread); 0: never. The same result every time.
    std::uint64_t effort = 0;
};

/// Tc without holes (METHOD 2.2): branch and bound over Q and the two sphere trees. Every pair whose gap gets
/// <= margin (its threshold plus margin, where the rule has one) somewhere in Q is listed, and none whose gap
/// stays > margin + tau. An empty list is a proof that the bodies never collide (2.3). Stopped
/// early by progress it is not certified. The same result for any number of threads.
CandidatePairs searchCertified(const SphereSet& a, const SphereSet& b, const Motion& motion,
                               const CertifiedSearchOptions& options = {}, const Progress& progress = {});

/// Whether a short search proves that no pair of spheres touches, or gets within the margin, at any pose of
/// Q.
bool neverCollide(const SphereSet& a, const SphereSet& b, const Motion& motion, const ContactRule& rule,
                  double margin, const Progress& progress = {});

/// A distance that two bodies which never meet are proven to keep at every pose of Q: within a few tens of
/// percent of the true one; 0 when none could be shown. Infinite where one of them has no spheres. cells,
/// when given, is raised by the cells of Q that the proof took. Each of the few distances tried is given up
/// after `effort` looks, as above.
double provenClearance(const SphereSet& a, const SphereSet& b, const Motion& motion,
                       std::uint64_t* cells = nullptr, const Progress& progress = {},
                       std::uint64_t effort = 0);

} // namespace tss
