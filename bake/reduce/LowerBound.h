#pragma once
#include "bake/reduce/CoverProof.h"

#include <span>

namespace tss {

/// What a pose demands of every table: some one of these pairs.
struct PoseConstraint {
    std::vector<double> pose;
    std::vector<SpherePair> pairs; ///< sorted
};

/// All pairs that answer at each pose; poses with more than `most` of them, or with none owed, are left out.
std::vector<PoseConstraint> constraintsAt(const CoverProblem& problem, const ErrorContract& owed,
                                          const std::vector<std::vector<double>>& poses, std::size_t most);

/// The fewest pairs found that meet all demands, and the fewest there can be: a bound for every table,
/// however it is made.
struct PairCover {
    std::vector<SpherePair> pairs; ///< sorted
    double lowerBound = 0;
};
PairCover coverConstraints(const std::vector<PoseConstraint>& demands);

/// The same for demands without poses. rows: pairs any one of which meets a demand, not empty, sorted.
PairCover coverPairs(const std::vector<std::span<const SpherePair>>& rows);

} // namespace tss
