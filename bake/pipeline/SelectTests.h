#pragma once
#include "bake/base/Error.h"
#include "bake/pipeline/SearchPair.h"
#include "bake/reduce/Reductions.h"

namespace tss {

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
