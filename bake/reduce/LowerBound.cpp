#include "bake/reduce/LowerBound.h"

#include "bake/base/Parallel.h"
#include "bake/reduce/SetCover.h"
#include "bake/search/NodePairs.h"

#include <algorithm>
#include <limits>
#include <map>

namespace tss {

namespace {

/// The pairs that answer at a pose; none where the contract asks for nothing.
std::vector<SpherePair> answersAt(const CoverProblem& problem, const ErrorContract& contract,
                                  const Pose& at) {
    double models = std::numeric_limits<double>::infinity();
    std::vector<std::pair<double, SpherePair>> near;
    // The contract is about gaps counted from where contact begins, which are no smaller than those of the
    // spheres: the visit misses none.
    visitPairsWithin(problem.treeA, problem.treeB, at, contract.margin + contract.epsilon,
                     [&](std::uint32_t i, std::uint32_t j, double) {
                         const std::optional<ContactPair> pair = problem.contactPair({i, j});
                         if (!pair) return;
                         const double gap = problem.gap(*pair, at);
                         near.emplace_back(gap, pair->pair);
                         models = std::min(models, gap);
                     });
    std::vector<SpherePair> pairs;
    if (models > contract.margin) return pairs;
    for (const auto& [gap, pair] : near)
        if (gap <= contract.answer(models) + problem.band) pairs.push_back(pair);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

} // namespace

std::vector<PoseConstraint> constraintsAt(const CoverProblem& problem, const ErrorContract& contract,
                                          const std::vector<std::vector<double>>& poses, std::size_t most) {
    std::vector<PoseConstraint> constraints(poses.size());
    parallelFor(poses.size(), [&](std::size_t k) {
        constraints[k] = {poses[k], answersAt(problem, contract, pose(problem.motion, poses[k]))};
    });
    std::erase_if(constraints,
                  [&](const PoseConstraint& d) { return d.pairs.empty() || d.pairs.size() > most; });
    return constraints;
}

PairCover coverPairs(const std::vector<std::span<const SpherePair>>& rows) {
    std::map<SpherePair, std::uint32_t> number;
    for (const auto& row : rows)
        for (const SpherePair& pair : row) number.emplace(pair, 0);
    std::vector<SpherePair> pairs;
    for (auto& [pair, n] : number) {
        n = static_cast<std::uint32_t>(pairs.size());
        pairs.push_back(pair);
    }
    std::vector<std::vector<std::uint32_t>> columns;
    for (const auto& row : rows) {
        columns.emplace_back();
        for (const SpherePair& pair : row) columns.back().push_back(number[pair]);
    }
    const SetCover cover = coverRows(std::move(columns));
    PairCover result;
    result.lowerBound = cover.lowerBound;
    for (std::uint32_t c : cover.chosen) result.pairs.push_back(pairs[c]);
    return result;
}

PairCover coverConstraints(const std::vector<PoseConstraint>& constraints) {
    std::vector<std::span<const SpherePair>> rows;
    for (const PoseConstraint& constraint : constraints) rows.emplace_back(constraint.pairs);
    return coverPairs(rows);
}

} // namespace tss
