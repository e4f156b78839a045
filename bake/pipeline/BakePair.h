#pragma once
#include "bake/pipeline/Bake.h"
#include "bake/pipeline/FillPair.h"

namespace tss {

/// What a pair has instead of its meshes at run time: one of the two.
struct PairTable {
    std::shared_ptr<const Table> table;
    std::shared_ptr<const NeverCollides> proof;
};

/// Search, reduction and bounds over spheres from fillPair() (METHOD 2, 3). What a person should know, and
/// the epsilon reached, go into the report.
PairTable tabulatePair(const PairSpheres& spheres, const Motion& motion, const BakeOptions& options,
                       PairReport& report, const Progress& progress = {});

/// One pair from its meshes to its table or its proof (METHOD 1 to 3). The result goes into the pair; what a
/// person should know goes into the report.
void bakePair(SceneModel& scene, Pair& pair, const BakeOptions& options, PairReport& report,
              const Progress& progress);

} // namespace tss
