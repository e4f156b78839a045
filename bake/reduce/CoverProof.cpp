#include "bake/reduce/CoverProof.h"

#include "bake/base/Batches.h"

#include <algorithm>
#include <limits>
#include <tbb/enumerable_thread_specific.h>

namespace tss {

namespace {

/// What one thread of a round did with its cell: the cells it left open, and the pair that the cover lacks.
struct PartResult {
    std::vector<OpenCell> left;
    std::optional<Counterexample> lacking;
    std::uint64_t cells = 0, looks = 0;
};

/// Depth first from one cell, until a pair is lacking, or for at most `steps` cells or about `looks` looks,
/// or as long as there is time.
PartResult runPart(CellExaminer& examiner, OpenCell cell, std::uint64_t steps, std::uint64_t looks,
                   const CoverBudget& budget) {
    PartResult result;
    result.left.push_back(std::move(cell));
    const std::uint64_t before = examiner.looks();
    while (!result.left.empty() && result.cells < steps && result.looks < looks && !budget.late()) {
        CellVerdict verdict = examiner.examine(result.left.back());
        ++result.cells;
        result.looks = examiner.looks() - before;
        if (verdict.lacking) {
            result.lacking = std::move(verdict.lacking);
            break;
        }
        result.left.pop_back();
        for (auto half = verdict.halves.rbegin(); half != verdict.halves.rend(); ++half)
            result.left.push_back(std::move(*half));
    }
    return result;
}

/// Adds the pairs that a round found lacking, except those that a pair added before in the round answers.
class Additions {
public:
    Additions(const CoverProblem& problem, const ErrorContract& contract, GrowingCover& cover,
              CoverProof& proof)
        : problem_(problem), contract_(contract), cover_(cover), proof_(proof),
          first_(cover.members().size()) {}

    void add(const Counterexample& lacking) {
        if (cover_.set().contains(lacking.pair.pair)) return;
        if (lacking.pose.empty()) {
            if (cover_.members().size() > first_)
                return; // the new members may do: the cell is looked at again
            ++proof_.forced;
        } else {
            const Pose at = pose(problem_.motion, lacking.pose);
            if (cover_.gap(at, first_) <= contract_.answer(problem_.gap(lacking.pair, at))) return;
            proof_.counterexamples.push_back(lacking.pose);
        }
        cover_.add(lacking.pair);
    }

private:
    const CoverProblem& problem_;
    const ErrorContract& contract_;
    GrowingCover& cover_;
    CoverProof& proof_;
    std::size_t first_;
};

/// The share of Q that is shown, from the volumes of the cells left.
double shareDone(const CoverProblem& problem, const std::vector<OpenCell>& left) {
    double open = 0;
    for (const OpenCell& cell : left) {
        double volume = 1;
        for (std::size_t k = 0; k < problem.motion.dofCount(); ++k) {
            const Dof& dof = problem.motion.dofs[k];
            if (dof.upper > dof.lower)
                volume *= (cell.box.upper[k] - cell.box.lower[k]) / (dof.upper - dof.lower);
        }
        open += volume;
    }
    return std::clamp(1 - open, 0.0, 1.0);
}

} // namespace

bool CoverBudget::late() const {
    return seconds > 0 && watch.seconds() >= seconds;
}

bool CoverBudget::spent(std::uint64_t looksUsed, double share) const {
    const double used = std::max(looks > 0 ? double(looksUsed) / double(looks) : 0,
                                 seconds > 0 ? watch.seconds() / seconds : 0);
    if (used >= 1) return true;
    // From a tenth on: at this rate it would not end.
    if (toTheEnd && used >= 0.1 && share < used) return true;
    return !report(progress, "certified cover", share);
}

double GrowingCover::gap(const Pose& pose, std::size_t first) const {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t k = first; k < members_.size(); ++k)
        best = std::min(best, problem_->gap(members_[k], pose));
    return best;
}

CoverProof proveCover(const CoverProblem& problem, const ErrorContract& contract, GrowingCover& cover,
                      std::vector<OpenCell> cells, const CoverBudget& budget) {
    constexpr std::size_t width = 64;
    CoverProof proof;
    tbb::enumerable_thread_specific<CellExaminer> examiners(
        [&] { return CellExaminer(problem, contract, cover.members(), cover.set()); });
    proof.left = std::move(cells);
    std::reverse(proof.left.begin(), proof.left.end());
    while (!proof.left.empty()) {
        if (budget.spent(proof.looks, shareDone(problem, proof.left))) return proof;
        const auto parts = runLast(proof.left, width, [&](OpenCell cell, std::size_t count) {
            const std::uint64_t looks =
                budget.looks > 0 ? (budget.looks - proof.looks) / count + 1 : std::uint64_t(-1);
            return runPart(examiners.local(), std::move(cell), count < width / 4 ? 16 : 256, looks, budget);
        });
        Additions additions(problem, contract, cover, proof);
        for (const PartResult& part : parts) {
            proof.cells += part.cells;
            proof.looks += part.looks;
            if (part.lacking) additions.add(*part.lacking);
        }
    }
    proof.complete = true;
    return proof;
}

} // namespace tss
