#pragma once
#include "bake/fill/HollowBodies.h"
#include "bake/search/AtRest.h"
#include "bake/search/RestContact.h"
#include "bake/spheres/SphereMethods.h"

namespace tss {

/// What the fitting of spheres to one body has to respect where the joint rests.
struct RestSide {
    std::vector<Patch> patches; ///< the whole surface; Patch::region is set within the region that overlaps
    std::shared_ptr<const RestNeighbour>
        neighbour;         ///< constraint of all spheres outside the region; null: none
    MedialSet region;      ///< spheres of the region, the same for all tolerances
    double protrusion = 0; ///< of these, scene units
};

/// How the spheres of two bodies are to be fitted with regard to rest (METHOD 2.4): where the meshes are
/// apart there, so are the spheres, whatever their tolerance; where these overlap, all but those of the
/// region.
struct RestPlan {
    RestContact contact;
    HollowBodies entered; ///< at rest, surfaces apart, the other body is inside it: it has to be taken for
                          ///< hollow, and a and b are not set
    RestSide a, b;
};

struct RestPlanOptions {
    double tolerance = 0; ///< of the spheres, scene units, > 0
    double epsilon = 0;   ///< of the table, scene units: at rest spheres must be farther apart than that
    AtRest atRest = AtRest::Offset;
    bool clear = true; ///< false: spheres are made without regard to the clearance at rest
    MedialOptions medial;
};

/// Throws InputError where the clearance at rest leaves no room for the spheres; with AtRest::Collide they
/// are then made without regard to it.
RestPlan planRest(const Solid& a, const MeshQuery& surfaceA, const Solid& b, const MeshQuery& surfaceB,
                  const Motion& motion, const RestPlanOptions& options, const Progress& progress = {});

} // namespace tss
