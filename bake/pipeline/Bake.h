#pragma once
#include "bake/base/Error.h"
#include "bake/base/Progress.h"
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
    double effort = 1; ///< in (0, 1]: this share of what a bake looks at and makes patches of at most
    /// Hears of each that is baked, once it is in the scene.
    std::function<void(const PairReport&)> done{};
    /// Hears of each that cannot be baked after all, and the others are baked; without it the error is
    /// thrown.
    std::function<void(const InputError&)> failed{};
    /// Asked often, from one thread at a time. True: nothing more is baked, and what is half done is as it
    /// was.
    std::function<bool()> interrupted{};
};

/// Whether bake() would make this pair's or skin's table.
bool toBake(const SceneModel& scene, const Pair& pair, const BakeRequest& request);
bool toBake(const SceneModel& scene, const SkinModel& skin, const BakeRequest& request);

/// The whole pipeline on one scene (METHOD 1 to 3): for each pair spheres, search, reduction, table and
/// bounds; for each skin the rows that its muscles can reach. Tables, proofs, hashes and settings go into the
/// scene. Throws InputError that names the prim for what
/// cannot be baked: what shows without making spheres (refusedByBake()) before any is made.
std::vector<PairReport> bake(SceneModel& scene, const BakeRequest& request = {},
                             const Progress& progress = {});

} // namespace tss
