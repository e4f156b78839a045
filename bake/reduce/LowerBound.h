#pragma once
#include "bake/reduce/CoverProof.h"
#include "bake/reduce/SetCover.h"

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
struct ConstraintCover {
    std::vector<SpherePair> pairs;
    double lowerBound = 0;
};
ConstraintCover coverConstraints(const std::vector<PoseConstraint>& demands);

} // namespace tss
