#pragma once
#include "bake/Bake.h"
#include "bake/spheres/GenerateSpheres.h"

namespace tss {

/// The spheres of both bodies as a file can hold them, with what is proven of them.
struct PairSpheres {
    SphereFit a, b;
};

/// Fills the two bodies of a pair as the options say (METHOD 1). The same spheres at every call.
PairSpheres fillPair(const SceneModel& scene, const Pair& pair, const Motion& motion,
                     const BakeOptions& options, const Progress& progress = {});

/// One pair from its meshes to its table or its proof (METHOD 1 to 3). The result goes into the pair; what a
/// person should know goes into the report.
void bakePair(SceneModel& scene, Pair& pair, const BakeOptions& options, PairReport& report,
              const Progress& progress);

/// One skin from its muscles to the rows that they can reach (METHOD 6.2).
void bakeSkin(SceneModel& scene, SkinModel& skin, const BakeOptions& options, PairReport& report,
              const Progress& progress);

} // namespace tss
