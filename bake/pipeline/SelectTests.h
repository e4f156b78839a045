#pragma once
#include "bake/base/Error.h"
#include "bake/pipeline/RestRule.h"
#include "bake/reduce/Reductions.h"
#include "bake/search/CandidatePairs.h"

namespace tss {

/// What search, selection and bounds of one pair are about.
struct PairTask {
    const PairSpheres& spheres;
    const Motion& motion;
    const BakeOptions& options;
    RuleAtRest ruled;
    double margin = 0; ///< spheres that come this near are asked for, scene units, >= 0
};

/// The task for spheres from fillPair(). They are asked for within what they lack of the surfaces, so that a
/// table's own gap is no larger wherever the meshes meet (METHOD 3.5); 0 where that is nothing, or not known
/// of all of them.
PairTask pairTask(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options);

/// The pairs of spheres that can meet, or come within the margin (METHOD 2).
CandidatePairs searchPair(const PairTask& task, const Progress& progress);

/// Whether a short search shows that no two spheres of the task ever meet.
bool neverMeet(const PairTask& task, const Progress& progress);

/// Whether these are all: a search may run out of effort.
bool allListed(const CandidatePairs& candidates, const BakeOptions& options);

/// The table's tests by the method asked for. Only the cover proves something about every pose.
struct Selection {
    Reduced reduced;
    double epsilon = 0;
    bool certified = false;
    std::optional<NeverCollides> proof; ///< there is nothing to select from
};

/// A budget that ended before anything was proven.
class BudgetEnded : public InputError {
    using InputError::InputError;
};

/// The few pairs that answer for all, or the proof that none can meet (METHOD 3). Notes get what a person
/// should know. Throws BudgetEnded.
Selection selectTests(const PairTask& task, const CandidatePairs& candidates, std::vector<std::string>& notes,
                      const Progress& progress);

/// What a proof over spheres says of the meshes: these stay as far apart as the spheres do, less what they
/// lack of the surfaces. Where that is nothing, or the meshes meet at rest, there is no proof but a certified
/// table without tests.
void boundProof(Selection& selection, const PairTask& task);

/// What the meshes may expect of a certified table, but for the region that overlaps at rest (METHOD 3.5).
void boundTable(Table& table, const PairTask& task);

} // namespace tss
