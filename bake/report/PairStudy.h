#pragma once
#include "bake/report/Model.h"
#include "bake/report/Study.h"

namespace tss::reporting {

// Parts of studyPair(), each filling its own figures of the study.

/// Tests a step along a motion, and the angular region of collision.
void studySteps(PairStudy& study, const SceneModel& scene, const Pair& pair, const Model& model,
                const compare::MeshTruth& truth, const ReportOptions& options, int steps);

/// What tables from a sampled search miss of what the same spheres collide at.
void studySampling(PairStudy& study, const Model& model, const ReportOptions& options);

/// That the two never meet, in words, with the distance that `tss bake` proves and stores. model: one without
/// a test, made from the pair.
std::string neverText(const SceneModel& scene, const Pair& pair, const Model& model);

/// What a reader of the figures has to know of this pair, a sentence each: where the poses tell little, and
/// what has no row.
std::vector<std::string> notesOf(const PairStudy& study);

} // namespace tss::reporting
