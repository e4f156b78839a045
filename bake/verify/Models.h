#pragma once
#include "bake/verify/Verify.h"

namespace tss::verify {

/// Balls about balls, down to the spheres of a set.
struct BallTree {
    struct Ball {
        Vec3 centre = Vec3::Zero();
        double radius = 0;
        std::int32_t first = -1, second = -1; ///< children; -1 for a sphere
        std::uint32_t sphere = 0;
    };
    std::vector<Ball> balls; ///< the root is the last; empty for an empty set

    explicit BallTree(const SphereSet& spheres);
    std::int32_t root() const { return static_cast<std::int32_t>(balls.size()) - 1; }

private:
    std::int32_t join(const SphereSet& spheres, std::vector<std::uint32_t>& order, std::size_t from,
                      std::size_t to);
};

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
