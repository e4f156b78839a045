#pragma once
#include "bake/base/Error.h"
#include "bake/pipeline/RestRule.h"
#include "bake/reduce/Reductions.h"
#include "bake/search/CandidatePairs.h"

namespace tss {

/// The input of search, selection and bounds for one pair.
struct PairTask {
    const PairSpheres& spheres;
    const Motion& motion;
    const BakeOptions& options;
    RuleAtRest ruled;
    double margin = 0; ///< pairs of spheres whose gap gets this small are of interest, scene units, >= 0
};

/// The task for spheres from fillPair(). The margin is the sum of both coverages, so that a table's own gap
/// is no larger than it wherever the meshes meet (METHOD 3.5); 0 where the coverage is not bounded.
PairTask pairTask(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options);

/// The pairs of spheres that can meet, or come within the margin (METHOD 2).
CandidatePairs searchPair(const PairTask& task, const Progress& progress);

/// Whether the list is what the search asked for finds; a certified search that ran out of effort is not.
bool allListed(const CandidatePairs& candidates, const BakeOptions& options);

/// The table's tests by the method asked for. Only the cover proves something about every pose.
struct Selection {
    Reduced reduced;
    double epsilon = 0;
    bool certified = false;
    std::optional<NeverCollides> proof; ///< set where no pair can meet: there is nothing to select from
};

/// The budget ended before anything was proven.
class BudgetEnded : public InputError {
    using InputError::InputError;
};

/// The few pairs that answer for all, or the proof that none can meet (METHOD 3). Notes get what a person
/// should know. Throws BudgetEnded.
Selection selectTests(const PairTask& task, const CandidatePairs& candidates, std::vector<std::string>& notes,
                      const Progress& progress);

/// Turns the clearance of the spheres in a proof into that of the meshes, which is less by both coverages.
/// Where nothing is left, or the meshes meet at rest, the proof is dropped and leaves a certified table
/// without tests.
void boundProof(Selection& selection, const PairTask& task);

/// Fills in the bounds of a certified table against the meshes, the exempt region apart (METHOD 3.5).
void boundTable(Table& table, const PairTask& task);

} // namespace tss
