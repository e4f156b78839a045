#pragma once
#include "bake/fill/HollowBodies.h"
#include "bake/search/AtRest.h"
#include "bake/search/RestContact.h"
#include "bake/spheres/SphereMethods.h"

namespace tss {

/// What fitting spheres to a body needs to know of where the joint rests.
struct RestSide {
    std::vector<Patch> patches;                     ///< the whole surface; `region` is set where that is so
    std::shared_ptr<const RestNeighbour> neighbour; ///< of all spheres but those of the region; null: none
    MedialSet region;      ///< spheres of the region, made once and for all tolerances
    double protrusion = 0; ///< what they stick out at most
};

/// How the spheres of two bodies are to be fitted with regard to rest (METHOD 2.4): where the meshes are
/// apart there, so are the spheres, whatever their tolerance; where these overlap, all but those of the
/// region.
struct RestPlan {
    RestContact contact;
    HollowBodies
        entered; ///< apart at rest, and yet one is where the other would be filled: nothing else is set
    RestSide a, b;
};

struct RestPlanOptions {
    double tolerance = 0; ///< of the spheres, scene units, > 0
    double epsilon = 0;   ///< of the table: spheres must be farther apart than that
    AtRest atRest = AtRest::Offset;
    bool clear = true; ///< else the spheres are made without regard to rest where the meshes are apart
    MedialOptions medial;
};

/// Throws InputError where the clearance at rest leaves no room for the spheres; with AtRest::Collide they
/// are then made without regard to it.
RestPlan planRest(const Solid& a, const MeshQuery& surfaceA, const Solid& b, const MeshQuery& surfaceB,
                  const Motion& motion, const RestPlanOptions& options, const Progress& progress = {});

} // namespace tss
