#pragma once
#include "bake/Bake.h"

namespace tss {

/// One pair from its meshes to its table or its proof (METHOD 1 to 3). The result goes into the pair; what a
/// person should know goes into the report.
void bakePair(SceneModel& scene, Pair& pair, const BakeOptions& options, PairReport& report,
              const Progress& progress);

/// One skin from its muscles to the rows that they can reach (METHOD 6.2).
void bakeSkin(SceneModel& scene, SkinModel& skin, const BakeOptions& options, PairReport& report,
              const Progress& progress);

} // namespace tss
