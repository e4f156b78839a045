#pragma once
#include "bake/base/Progress.h"
#include "bake/pipeline/BakeOptions.h"

namespace tss {

struct BakeRequest {
    BakeSettings given;             ///< settings that override the scene's own
    std::vector<std::string> pairs; ///< prim paths of the pairs and skins to bake; empty: all
};

/// What came of one pair or one skin.
struct PairReport {
    std::string path;
    double seconds = 0;
    double epsilon = 0; ///< reached
    std::vector<std::string>
        notes; ///< what a person should know: mesh defects, overlap at rest, a budget that ended
};

/// The whole pipeline on one scene (METHOD 1 to 3): for each pair spheres, search, reduction, table and
/// bounds; for each skin the rows that its muscles can reach. Tables, proofs and hashes go into the scene.
/// Throws InputError that names the prim for what cannot be baked.
std::vector<PairReport> bake(SceneModel& scene, const BakeRequest& request, const Progress& progress = {});

} // namespace tss
