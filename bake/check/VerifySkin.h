#pragma once
#include "bake/base/Progress.h"
#include "bake/model/SceneModel.h"

#include <string>
#include <vector>

namespace tss {

/// What came out of looking at a skin's table again. Nothing is proven of what it answers while the skin
/// moves, or several muscles and bones do: its rows come from a search.
struct SkinVerdict {
    std::string reason;             ///< what is wrong with it, in words; empty: nothing was found
    std::vector<std::string> notes; ///< what was looked at, and what is not proven
    std::size_t states = 0;         ///< a muscle at an activation that was looked at
    double lateAtRest = 0;          ///< at rest a muscle is no more than this nearer to a place of the skin
                                    ///< than the tests there say, scene units
    double late = 0;                ///< the same at those states
    bool holds() const { return reason.empty(); }
};

/// Checks, with code of its own, from the file and the meshes, what can be told of a skin's table:
/// - it is fresh and states no bound, for none is proven;
/// - its skin spheres stand at the vertices that they ride on, with the radius that was asked for, and its
///   thresholds are the gaps at rest;
/// - each of its muscle spheres, carried by its muscle alone over the activation range, the bones and the
///   skin at rest, has a test with every vertex that it comes within `travel` of: at the nodes of its track
///   and between them, as the run time moves it;
/// - where a muscle's surface is within the skin's thickness of a vertex, some test there tells how near, at
///   rest and at the nodes: `late` says by how much it does not. Spheres that contain the surface must not be
///   late at rest, and no later over the range than the skin is thick.
/// Throws InputError for a scene whose muscles cannot be used.
SkinVerdict verifySkin(const SceneModel& scene, const SkinModel& skin, const Progress& progress = {});

} // namespace tss
