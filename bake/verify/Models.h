#pragma once
#include "bake/verify/BallTree.h"
#include "bake/verify/Verify.h"

namespace tss::verify {

/// The two whole sphere sets and when a pair of theirs is in contact.
struct Models {
    const SphereSet &a, &b;
    const Motion& motion;
    BallTree treeA, treeB;
    std::vector<char> regionA, regionB; ///< as in VerifyOptions
    double depth;
    double size = 0;   ///< a bound for every coordinate in A's frame
    double extent = 0; ///< of both bodies

    Models(const SphereSet& a, const SphereSet& b, const Motion& motion, const VerifyOptions& options);

    /// The distance of centres at which the pair's contact begins; < 0: never.
    double contactDistance(SpherePair pair) const;
};

/// A test of the table: which spheres, as given in the table, and the distance at which it reports contact.
struct Test {
    Vec3 centreA, centreB;
    double contactDistance = 0;
    std::optional<SpherePair> same; ///< the pair of the whole sets that it is, to the bit
};

/// The tests of a table, matched with the whole sets. reason is set when one is not theirs: a sphere that
/// sticks out of every sphere of the set by more than the table's epsilon and `band`, or (epsilon 0) differs
/// from all in some bit; a rest gap that makes it report contact before its pair does.
std::vector<Test> matchTests(const Models& models, const Table& table, double band, std::string& reason);

/// Why a table made for the first motion says nothing about the second; empty: it covers it.
std::string motionMismatch(const Motion& made, const Motion& asked);

} // namespace tss::verify
