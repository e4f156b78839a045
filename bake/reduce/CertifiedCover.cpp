#include "bake/reduce/CertifiedCover.h"

#include "bake/base/Error.h"
#include "bake/base/Infinity.h"
#include "bake/base/Parallel.h"
#include "bake/reduce/CoverProof.h"
#include "bake/reduce/LowerBound.h"
#include "bake/search/CertifiedSearch.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Poses with more answers than this say little about how small a table can be and cost much.
constexpr std::size_t mostAnswers = 2000;

/// At most so many further proofs to make a proven table smaller.
constexpr int mostRounds = 24;

/// Looks for the clearance of bodies that never meet, which is only information for people.
constexpr std::uint64_t clearanceEffort = 20'000'000;

/// One cover from the first proof to the result.
class CoverSearch {
public:
    CoverSearch(const CoverProblem& problem, const CoverOptions& options, const Progress& progress)
        : problem_(problem), contract_{options.epsilon, options.gapDepth, options.gapMargin},
          options_(options), cover_(problem) {
        budget_.looks = options.looks;
        budget_.seconds = options.seconds;
        budget_.progress = progress;
        budget_.toTheEnd = !options.coarser;
    }

    CoverResult run() {
        const CoverProof first = prove(contract_, cover_, 0.6);
        result_.forced = first.forced;
        if (first.complete) {
            result_.epsilon = contract_.epsilon;
            makeSmaller();
        } else if (!options_.coarser) {
            result_.epsilon = infinity;
            return result_;
        } else {
            const double left = epsilonLeft(first.left); // before more is added to the cover
            result_.epsilon = std::min(left, relaxEpsilon());
        }
        return finish();
    }

private:
    /// A proof over all of Q within a share of the budget that is left.
    CoverProof prove(const ErrorContract& contract, GrowingCover& cover, double share) {
        CoverBudget part = budget_;
        part.watch.restart();
        if (budget_.seconds > 0)
            part.seconds = std::max(1e-9, share * (budget_.seconds - budget_.watch.seconds()));
        if (budget_.looks > 0)
            part.looks = std::max<std::uint64_t>(
                1, static_cast<std::uint64_t>(
                       share * double(budget_.looks - std::min(budget_.looks, result_.looks))));
        CoverProof proof = proveCover(problem_, contract, cover, {wholeProblem(problem_)}, part);
        result_.cells += proof.cells;
        result_.looks += proof.looks;
        if (!proof.complete && !options_.coarser) return proof;
        // A pose that needs one of its pairs at a coarser epsilon needs one at the epsilon asked for as well,
        // and there fewer pairs answer.
        const auto more = constraintsAt(problem_, contract_, proof.counterexamples, mostAnswers);
        constraints_.insert(constraints_.end(), more.begin(), more.end());
        return proof;
    }

    /// Starts again and again from the smallest list that answers at all poses found so far; each proof finds
    /// poses that this list misses, until it misses none or is within 2 % of its lower bound.
    void makeSmaller() {
        for (int round = 0; round < mostRounds; ++round) {
            const PairCover smallest = coverConstraints(constraints_);
            if (double(cover_.members().size()) <= 1.02 * smallest.lowerBound) return;
            GrowingCover next(problem_);
            for (const SpherePair& pair : smallest.pairs) {
                next.add(*problem_.contactPair(pair));
            }
            const CoverProof proof = prove(contract_, next, 1);
            if (!proof.complete) return;
            if (next.members().size() < cover_.members().size()) {
                cover_ = std::move(next);
                result_.forced = proof.forced;
            }
            if (proof.counterexamples.empty()) return;
        }
    }

    /// The epsilon with which the cover answers over all the cells that a proof left open.
    double epsilonLeft(const std::vector<OpenCell>& left) const {
        std::vector<double> worst(left.size());
        parallelFor(left.size(), [&](std::size_t k) {
            worst[k] = CellExaminer(problem_, contract_, cover_.members(), cover_.set()).epsilonOver(left[k]);
        });
        return worst.empty() ? contract_.epsilon : *std::max_element(worst.begin(), worst.end());
    }

    /// An epsilon with which some single member answers at every pose: the gaps of two pairs differ by no
    /// more than the distances between their spheres.
    double epsilonAnywhere() const {
        double least = infinity;
        const SphereTree::Node &a = problem_.treeA[0], &b = problem_.treeB[0];
        for (const ContactPair& member : cover_.members()) {
            const double apart = (problem_.a[member.pair.a].centre - a.centre).norm() +
                                 (problem_.b[member.pair.b].centre - b.centre).norm();
            least = std::min(least, apart + a.radius + b.radius - member.contactDistance + problem_.band);
        }
        return std::max(least, contract_.epsilon);
    }

    /// Where the budget did not suffice for the epsilon asked for: proves coarser ones, each half of the
    /// last, until the budget ends. Returns the smallest that is proven.
    double relaxEpsilon() {
        double reached = epsilonAnywhere();
        for (double epsilon = problem_.size; epsilon > contract_.epsilon; epsilon *= 0.5) {
            ErrorContract coarser = contract_;
            coarser.epsilon = epsilon;
            if (!prove(coarser, cover_, 1).complete) break;
            reached = std::min(reached, epsilon);
        }
        return reached;
    }

    CoverResult finish() {
        result_.complete = result_.epsilon <= contract_.epsilon;
        for (const ContactPair& member : cover_.members()) result_.pairs.push_back(member.pair);
        std::sort(result_.pairs.begin(), result_.pairs.end());
        result_.restGaps = problem_.rule.thresholds(result_.pairs);
        // At a coarser epsilon fewer pairs may do: the bound does not hold then.
        if (result_.complete) result_.lowerBound = coverConstraints(constraints_).lowerBound;
        return result_;
    }

    const CoverProblem& problem_;
    const ErrorContract contract_;
    const CoverOptions& options_;
    CoverBudget budget_;
    GrowingCover cover_;
    std::vector<PoseConstraint> constraints_;
    CoverResult result_;
};

void check(const CoverOptions& options) {
    for (const auto& [name, value] : {std::pair{"epsilon", options.epsilon},
                                      {"gap depth", options.gapDepth},
                                      {"gap margin", options.gapMargin},
                                      {"time budget", options.seconds}})
        if (!std::isfinite(value) || value < 0)
            throw InputError(std::string(name) + ": expected a finite number, not negative");
}

} // namespace

CoverResult certifiedCover(const SphereSet& a, const SphereSet& b, const CandidatePairs* candidates,
                           const Motion& motion, const CoverOptions& options, const Progress& progress) {
    check(options);
    if (motion.dofCount() > mostCoverDofs)
        throw InputError("cover: expected at most " + std::to_string(mostCoverDofs) + " DOFs, found " +
                         std::to_string(motion.dofCount()));
    const CoverProblem problem(a, b, motion, options.rule, candidates ? &candidates->pairs : nullptr);
    CoverResult result = CoverSearch(problem, options, progress).run();
    if (result.complete && result.pairs.empty() && !candidates && options.rule.empty())
        result.clearance = std::max(options.gapMargin,
                                    provenClearance(a, b, motion, &result.cells, progress, clearanceEffort));
    return result;
}

} // namespace tss
