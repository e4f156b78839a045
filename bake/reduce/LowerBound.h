#pragma once
#include "bake/reduce/CoverProof.h"
#include "bake/reduce/SetCover.h"

namespace tss {

/// What a pose demands of every table: some one of these pairs.
struct Demand {
    std::vector<double> pose;
    std::vector<SpherePair> pairs; ///< sorted
};

/// All pairs that answer at each pose; poses with more than `most` of them, or with none owed, are left out.
std::vector<Demand> demandsAt(const CoverProblem& problem, const Obligation& owed,
                              const std::vector<std::vector<double>>& poses, std::size_t most);

/// The fewest pairs found that meet all demands, and the fewest there can be: a bound for every table,
/// however it is made.
struct DemandCover {
    std::vector<SpherePair> pairs;
    double lowerBound = 0;
};
DemandCover coverDemands(const std::vector<Demand>& demands);

} // namespace tss
