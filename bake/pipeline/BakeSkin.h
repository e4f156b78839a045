#pragma once
#include "bake/pipeline/Bake.h"
#include "bake/search/SkinSearch.h"

namespace tss {

/// The muscles of a skin, filled with spheres.
struct FilledMuscles {
    std::vector<std::shared_ptr<const MuscleDeformer>> deformers;
    std::vector<SkinSearchMuscle> searched; ///< point to the deformers
};
FilledMuscles fillMuscles(const SceneModel& scene, const SkinModel& skin, const BakeOptions& options,
                          PairReport& report, const Progress& progress = {});

/// One skin from its muscles to the rows that they can reach (METHOD 6.2).
void bakeSkin(SceneModel& scene, SkinModel& skin, const BakeOptions& options, PairReport& report,
              const Progress& progress);

} // namespace tss
