#pragma once
#include "bake/report/Model.h"
#include "bake/report/Study.h"

namespace tss::reporting {

/// That the two never meet, in words, with the distance that `tss bake` proves and stores. model: one without
/// a test, made from the pair.
std::string neverText(const SceneModel& scene, const Pair& pair, const Model& model);

/// What a reader of the figures has to know of this pair, a sentence each: where the poses tell little, and
/// what has no row.
std::vector<std::string> notesOf(const PairStudy& study);

} // namespace tss::reporting
