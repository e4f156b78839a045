#pragma once
#include "bake/base/Error.h"
#include "bake/base/Progress.h"
#include "bake/base/Stopwatch.h"
#include "bake/pipeline/BakeOptions.h"

#include <functional>

namespace tss {

/// What came of one pair or one skin.
struct PairReport {
    std::string path;
    double seconds = 0;
    double epsilon = 0; ///< reached
    std::vector<std::string>
        notes; ///< what a person should know: mesh defects, overlap at rest, a budget that ended
};

struct BakeRequest {
    BakeSettings given;             ///< settings that override the scene's own
    std::vector<std::string> pairs; ///< prim paths of the pairs and skins to bake; empty: all
    bool onlyMissing = false;       ///< not those whose table fits the scene and the settings already
    /// What is not baked by then is left as it was before. Pairs that matter most come first, each for a
    /// turn of some of the time (BakeTurns).
    Deadline until{};
    double effort = 1; ///< share of the usual limits of looks and patches, in (0, 1]
    /// Called for each that is baked, once it is in the scene, from one thread at a time; where there is no
    /// time limit in the scene's order, pairs first. Neither this nor the next may throw.
    std::function<void(const PairReport&)> done{};
    /// Called for each that cannot be baked, and the others are baked; without it the error is thrown.
    std::function<void(const InputError&)> failed{};
    /// Asked often, from one thread at a time. True: nothing more is baked, and what is half done is left as
    /// it was before.
    std::function<bool()> interrupted{};
};

/// Throws InputError where the scene has no pair and no skin of one of these prim paths. file: that of the
/// scene, for the message.
void expectPaths(const SceneModel& scene, const std::vector<std::string>& paths,
                 const std::string& file = {});

/// Whether a request is about the pair or skin of this prim path.
bool isWanted(const BakeRequest& request, const std::string& path);

/// The prim paths of all pairs and skins for which bake() would make a table.
std::vector<std::string> pathsToBake(const SceneModel& scene, const BakeRequest& request);

/// The whole pipeline on one scene (METHOD 1 to 3): for each pair spheres, search, reduction, table and
/// bounds; for each skin the rows that its muscles can reach. Up to four at once, each with the same result
/// as alone. Tables, proofs, hashes and settings go into the scene. Throws InputError that names the prim for
/// what cannot be baked: what shows without making spheres (refusedByBake()) before any is made.
std::vector<PairReport> bake(SceneModel& scene, const BakeRequest& request = {},
                             const Progress& progress = {});

} // namespace tss
