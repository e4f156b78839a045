#pragma once
#include "bake/base/Progress.h"
#include "bake/table/Table.h"

namespace tss {

struct VerifyOptions {
    /// For each sphere whether it stands for what overlaps at rest (METHOD 2.4); empty: none does. Pairs of
    /// those touch when they are deeper in each other than `depth`, scene units; < 0: never.
    std::vector<char> regionA, regionB;
    double depth = -1;
};

/// What came out of re-proving a table.
struct VerifyResult {
    bool proven = false; ///< the table keeps its promise at every pose of Q
    std::string reason;  ///< why not, in words; empty when proven
    std::vector<double>
        pose;                ///< DOF values that break it, or at which nothing could be decided; may be empty
    double band = 0;         ///< rounding granted on top of the table's epsilon, scene units
    std::uint64_t cells = 0; ///< cells of Q looked at
};

/// Proves again, with code of its own and without trust in the baker (METHOD 3.6):
/// - the table was made for this motion: same DOFs, the limits not wider than its own;
/// - its spheres are spheres of the whole sets (to the bit for epsilon 0, else not sticking out by more than
/// epsilon)
///   and its rest gaps are theirs: so it never reports what the models do not;
/// - at every pose of Q where the models' gap is <= gapMargin, the table's is <= max(gap, -gapDepth) +
/// epsilon. a, b: the whole sphere sets. Rounding errors are bounded beforehand and count against the table.
/// Deterministic.
VerifyResult verifyTable(const SphereSet& a, const SphereSet& b, const Table& table, const Motion& motion,
                         const VerifyOptions& options = {}, const Progress& progress = {});

} // namespace tss
