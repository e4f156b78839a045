#pragma once
#include "bake/report/Study.h"

namespace tss::reporting {

// Parts of studyPair(), each filling its own figures of the study.

/// Tests a step along a motion, and the angular region of collision.
void studySteps(PairStudy& study, const SceneModel& scene, const Pair& pair, const Model& model,
                const compare::MeshTruth& truth, const ReportOptions& options, int steps);

/// What tables from a sampled search miss of what the same spheres collide at.
void studySampling(PairStudy& study, const Model& model, const ReportOptions& options);

} // namespace tss::reporting
