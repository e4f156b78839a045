#include "bake/pipeline/SelectTests.h"

#include "bake/reduce/CertifiedCover.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tss {

namespace {

/// The seconds that a search for a cover may take; 0: any. Half of those that the pair has left: the other
/// half is for what is stored where no cover is found.
double secondsFor(const BakeOptions& options) {
    const double asked = options.budget.value_or(0);
    if (!options.until.comes()) return asked;
    const double half = std::max(1e-9, 0.5 * options.until.left());
    return asked > 0 ? std::min(asked, half) : half;
}

/// Every pair that the search has not ruled out; all pairs, where the search did not come to an end.
Selection selectAll(const PairTask& task, const CandidatePairs& candidates, std::vector<std::string>& notes) {
    const SphereSet &a = task.spheres.a.spheres, &b = task.spheres.b.spheres;
    const ContactRule& rule = task.ruled.rule;
    Selection selection;
    std::vector<SpherePair>& pairs = selection.reduced.pairs;
    if (candidates.certified) {
        pairs = candidates.pairs;
    } else {
        const auto canTouch = [&](const SpherePair& pair) {
            const double threshold = rule.threshold(pair); // -infinity: exempt at every depth
            return std::isfinite(threshold) && a[pair.a].radius + b[pair.b].radius + threshold >= 0;
        };
        for (std::uint32_t i = 0; i < a.size(); ++i)
            for (std::uint32_t j = 0; j < b.size(); ++j)
                if (canTouch({i, j})) pairs.push_back({i, j});
    }
    selection.reduced.restGaps = rule.thresholds(pairs);
    selection.certified = true;
    const bool hasCover = task.motion.dofCount() <= mostCoverDofs;
    notes.push_back(fmt::format(
        "which pairs of spheres imply others is too much to find out over {} "
        "degree{} of freedom{}: all {} that may meet are asked{}",
        task.motion.dofCount(), task.motion.dofCount() == 1 ? "" : "s",
        hasCover && secondsFor(task.options) > 0 ? " in the budget" : "", pairs.size(),
        hasCover && task.options.budget != 0 ? " (--again --budget 0 searches without a limit)" : ""));
    return selection;
}

/// The limits of a search for a cover: a number of looks, where no budget is set and all pairs can be tested
/// instead.
CoverOptions coverOptions(const PairTask& task, bool canTestAllInstead) {
    CoverOptions cover;
    if (task.options.budget || !canTestAllInstead) return cover;
    cover.looks = task.options.mostLooks;
    cover.coarser = false;
    return cover;
}

CoverResult coverOf(const PairTask& task, const CandidatePairs& candidates, CoverOptions cover,
                    const Progress& progress) {
    cover.epsilon = task.options.epsilon;
    cover.gapDepth = task.options.depth;
    cover.gapMargin = task.margin;
    cover.rule = task.ruled.rule;
    cover.seconds = secondsFor(task.options);
    return certifiedCover(task.spheres.a.spheres, task.spheres.b.spheres,
                          allListed(candidates, task.options) ? &candidates : nullptr, task.motion, cover,
                          progress);
}

Selection selectionOf(const PairTask& task, const CoverResult& result) {
    Selection selection;
    selection.reduced = result;
    selection.epsilon = result.epsilon;
    selection.certified = task.options.search == SearchMethod::Certified;
    if (selection.certified && result.complete && result.pairs.empty())
        selection.proof = NeverCollides{result.clearance, result.cells, {}, {}, {}};
    return selection;
}

/// A certified cover in place of all pairs, where it is found within the effort granted.
std::optional<Selection> selectFew(const PairTask& task, const CandidatePairs& candidates,
                                   const Progress& progress) {
    if (!manyDofs(task.motion, task.options) || task.motion.dofCount() > mostCoverDofs) return std::nullopt;
    CoverOptions cover = coverOptions(task, true);
    cover.coarser = false;
    const CoverResult result = coverOf(task, candidates, cover, progress);
    if (!result.complete) return std::nullopt;
    return selectionOf(task, result);
}

/// Whether tests with the epsilon that was reached report contact at rest, where the spheres have none.
bool touchesAtRest(const PairTask& task, const CoverResult& result) {
    if (task.options.atRest == AtRest::Collide) return false;
    const Pose rest = pose(task.motion, restValues(task.motion));
    return std::ranges::any_of(result.pairs, [&](const SpherePair& pair) {
        const Sphere &a = task.spheres.a.spheres[pair.a], &b = task.spheres.b.spheres[pair.b];
        const double gap = (rest * b.centre - a.centre).norm() - a.radius - b.radius;
        const double threshold = task.ruled.rule.threshold(pair); // -infinity: exempt at every depth
        return gap > threshold && gap <= threshold + result.epsilon;
    });
}

/// A certified cover: few pairs that answer like all of them at every pose.
Selection selectCover(const PairTask& task, const CandidatePairs& candidates, std::vector<std::string>& notes,
                      const Progress& progress) {
    const CoverResult result =
        coverOf(task, candidates, coverOptions(task, mayCoarsenToTestAll(task.options)), progress);
    if (!std::isfinite(result.epsilon))
        throw BudgetEnded("the budget ended before any bound was proven: expected a longer --budget, or a "
                          "coarser --tolerance or --epsilon");
    Selection selection = selectionOf(task, result);
    if (!result.complete && touchesAtRest(task, result))
        throw BudgetEnded(
            fmt::format("the budget ended at epsilon {}, and such a table would report contact where the "
                        "joint rests: expected a longer --budget, or a coarser --tolerance or --epsilon",
                        lengthText(result.epsilon, task.options.metersPerUnit)));
    if (!result.complete)
        notes.push_back(fmt::format("the budget ended first: epsilon {} was reached, not {}",
                                    lengthText(result.epsilon, task.options.metersPerUnit),
                                    lengthText(task.options.epsilon, task.options.metersPerUnit)));
    return selection;
}

} // namespace

Selection selectTests(const PairTask& task, const CandidatePairs& candidates, std::vector<std::string>& notes,
                      const Progress& progress) {
    Selection selection;
    if (candidates.certified && candidates.pairs.empty()) {
        selection.proof = NeverCollides{candidates.clearance, candidates.explored, {}, {}, {}};
        return selection;
    }
    if (task.spheres.testAll) {
        if (auto few = selectFew(task, candidates, progress)) return *few;
        return selectAll(task, candidates, notes);
    }
    switch (task.options.reduce) {
    case ReduceMethod::Cooccurrence:
        selection.reduced = reduceCooccurrence(candidates);
        break;
    case ReduceMethod::Minimal:
        selection.reduced = reduceMinimal(task.spheres.a.spheres, task.spheres.b.spheres, task.motion,
                                          sampledSearch(task), progress);
        break;
    case ReduceMethod::None:
        selection.reduced.pairs = candidates.pairs;
        selection.reduced.restGaps = candidates.restGaps;
        selection.certified = candidates.certified;
        break;
    case ReduceMethod::Cover:
        return selectCover(task, candidates, notes, progress);
    }
    return selection;
}

void boundProof(Selection& selection, const PairTask& task) {
    if (!selection.proof) return;
    double& clearance = selection.proof->clearance;
    clearance -= task.spheres.a.coverage + task.spheres.b.coverage;
    // Surface outside the contact zone is only known to stay this far away.
    if (task.spheres.zoneA || task.spheres.zoneB) clearance = std::min(clearance, task.spheres.zoneMargin);
    if (std::isfinite(clearance) && clearance > 0 && task.ruled.rule.empty() && task.ruled.region.empty())
        return;
    selection.proof.reset();
    selection.certified = true;
}

void boundTable(Table& table, const PairTask& task) {
    if (!table.certified) return;
    const SphereFit &a = task.spheres.a, &b = task.spheres.b;
    table.boundEarly =
        boundOrUnknown(std::max({a.protrusion + b.protrusion + table.epsilon, a.enclosed, b.enclosed}));
    // Tests were selected among the pairs that come within the margin; where the surfaces meet, some test
    // does.
    if (!task.ruled.bySpheres && task.margin >= a.coverage + b.coverage) table.boundMiss = task.margin;
    if (!(table.epsilon > 0)) return;
    // Where spheres touch, some test's gap is at most epsilon: counted as contact from there on it misses
    // nothing. At rest all are farther apart than that.
    table.restGaps.resize(table.testCount(), 0);
    for (double& gap : table.restGaps) gap += table.epsilon;
}

} // namespace tss
