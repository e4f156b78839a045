#include "bake/fill/NestedBodies.h"

#include "bake/base/Parallel.h"
#include "bake/fill/NestingCells.h"

#include <iterator>
#include <numeric>
#include <random>
#include <utility>

namespace tss {

namespace {

/// A bound of the distance from the surface of points inside a solid, scene units: half of the shortest side
/// of its bounding box; infinity where it has openings.
double deepestIn(const Solid& solid) {
    if (solid.hollow() || solid.mesh().vertices.empty()) return 0;
    return solid.open() ? std::numeric_limits<double>::infinity()
                        : (0.5 + 1e-9) * bounds(solid.mesh()).sizes().minCoeff();
}

/// What is known of both questions.
struct Answers {
    std::array<bool, 2> found{}, undecided{};
};

/// Branch and bound over Q, breadth first, so that a pose with a part inside is found early.
class NestingSearch {
public:
    NestingSearch(const NestingExaminer& examiner, const NestingEffort& effort, const Progress& progress)
        : examiner_(examiner), effort_(effort), progress_(progress), cells_{examiner.whole()} {}

    Answers run() {
        while (!cells_.empty() && examineAll())
            for (std::uint32_t question = 0; question < 2; ++question)
                if (willNotEnd(question)) answerFromLeft(question);
        for (std::uint32_t question = 0; question < 2; ++question) answerFromLeft(question);
        return answers_;
    }

private:
    /// Whether the effort will not suffice for a question. Asked from a thirtieth of it on.
    bool willNotEnd(std::uint32_t question) {
        const double most = 1.5 * (double(effort_.probes) - double(probes_)); // the estimate is a rough one
        return !over_[question] && 30 * probes_ > effort_.probes && expectedProbes(question, most) > most;
    }

    /// About how many probes the cells that are open take for a question, from random descents through their
    /// halves (Knuth 1975): one that gets k halvings down stands for 2^k cells there. No more than about
    /// `most`.
    double expectedProbes(std::uint32_t question, double most) {
        constexpr std::size_t descents = 1024;
        std::vector<NestingCell> open;
        for (const NestingCell& cell : cells_) {
            NestingCell asked{cell.cell, {}};
            std::ranges::copy_if(cell.parts, std::back_inserter(asked.parts),
                                 [&](const NestingPart& part) { return part.question == question; });
            if (!asked.parts.empty()) open.push_back(std::move(asked));
        }
        if (open.empty()) return 0;
        std::vector<double> expected(descents);
        parallelFor(descents, [&](std::size_t k) {
            std::mt19937_64 random(k);
            NestingCell cell = open[k * open.size() / descents];
            for (double weight = double(open.size()) / descents; expected[k] <= most; weight *= 2) {
                NestingVerdict verdict = examiner_.examine(cell);
                expected[k] += weight * double(verdict.probes);
                if (verdict.halves.empty()) break;
                cell = std::move(verdict.halves[random() % 2]);
            }
        });
        return std::accumulate(expected.begin(), expected.end(), 0.0);
    }

    /// Replaces the cells by the halves of those that are not decided. False: interrupted, or the effort
    /// ended, and cells are left that were not looked at.
    bool examineAll() {
        constexpr std::size_t batch = 64; // of fixed size, so that the outcome does not depend on threads
        std::vector<NestingCell> halves;
        for (std::size_t first = 0; first < cells_.size(); first += batch) {
            std::vector<NestingVerdict> results(std::min(batch, cells_.size() - first));
            parallelFor(results.size(), [&](std::size_t k) {
                NestingCell& cell = cells_[first + k];
                std::erase_if(cell.parts, [&](const NestingPart& part) { return over_[part.question]; });
                if (!cell.parts.empty()) results[k] = examiner_.examine(cell);
            });
            for (NestingVerdict& result : results) {
                probes_ += result.probes;
                for (std::size_t k = 0; k < 2; ++k) {
                    over_[k] = over_[k] || result.inside[k];
                    answers_.found[k] = answers_.found[k] || result.inside[k];
                    answers_.undecided[k] = answers_.undecided[k] || result.undecided[k];
                }
                std::ranges::move(result.halves, std::back_inserter(halves));
            }
            interrupted_ = !report(progress_, "nested bodies", double(probes_) / double(effort_.probes));
            if (!interrupted_ && probes_ <= effort_.probes) continue;
            cells_.erase(cells_.begin(), cells_.begin() + std::ptrdiff_t(first + results.size()));
            std::ranges::move(halves, std::back_inserter(cells_));
            return false;
        }
        cells_ = std::move(halves);
        return true;
    }

    /// Ends the search for a question: tries to answer it by random steps from some of the cells that are
    /// left.
    void answerFromLeft(std::uint32_t question) {
        constexpr std::size_t starts = 64;
        if (std::exchange(over_[question], true)) return;
        std::vector<std::pair<const NestingCell*, NestingPart>> left;
        for (const NestingCell& cell : cells_)
            for (const NestingPart& part : cell.parts)
                if (part.question == question) left.emplace_back(&cell, part);
        if (left.empty()) return;
        answers_.undecided[question] = true;
        if (interrupted_ || !effort_.walks) return;
        std::array<char, starts> inside{};
        parallelFor(starts, [&](std::size_t k) {
            const auto& [cell, part] = left[k * left.size() / starts];
            inside[k] = examiner_.leadsInside(*cell, part, k);
        });
        answers_.found[question] = std::ranges::find(inside, 1) != inside.end();
    }

    const NestingExaminer& examiner_;
    const NestingEffort& effort_;
    const Progress& progress_;
    std::vector<NestingCell> cells_;
    Answers answers_;
    std::array<bool, 2> over_{}; ///< per question: nothing more is asked about it
    std::uint64_t probes_ = 0;
    bool interrupted_ = false;
};

} // namespace

Nesting findNested(const Solid& a, const Solid& b, const Motion& motion, double reach,
                   const Progress& progress, const NestingEffort& effort) {
    const MotionRates rates(motion);
    const NestingExaminer examiner(a, b, rates, reach);
    const auto [found, undecided] = NestingSearch(examiner, effort, progress).run();
    return {{found[0], found[1]},
            {undecided[0] && !found[0], undecided[1] && !found[1]},
            settledShare * reach,
            std::max(found[0] ? 0 : deepestIn(a), found[1] ? 0 : deepestIn(b))};
}

Nesting insideIsContact(const Solid& a, const Solid& b) {
    return {{}, {true, true}, 0, std::max(deepestIn(a), deepestIn(b))};
}

} // namespace tss
