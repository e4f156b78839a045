#pragma once

#include <span>

namespace tss {

/// A pose at which every table needs at least one of these pairs.
struct PoseConstraint {
    std::vector<double> pose;
    std::vector<SpherePair> pairs; ///< sorted
};

/// The constraint of each pose: all pairs that answer there. Left out are poses at which nothing has to be
/// answered, and those with more than `most` pairs.
std::vector<PoseConstraint> constraintsAt(const CoverProblem& problem, const ErrorContract& contract,
                                          const std::vector<std::vector<double>>& poses, std::size_t most);

/// A small list of pairs that satisfies constraints, and a lower bound of the length of all such lists.
struct PairCover {
    std::vector<SpherePair> pairs; ///< sorted
    double lowerBound = 0;
};
PairCover coverConstraints(const std::vector<PoseConstraint>& constraints);

/// The same for constraints without poses. rows: of each, the pairs any one of which satisfies it; not empty,
/// sorted.
PairCover coverPairs(const std::vector<std::span<const SpherePair>>& rows);

} // namespace tss
