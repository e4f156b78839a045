#pragma once
#include "bake/spheres/Patches.h"
#include "bake/spheres/SphereOptions.h"

namespace tss {

/// Spheres, each with the radius of the ball about its centre that is inside the solid.
struct MedialSet {
    SphereSet spheres;
    std::vector<double> inner; ///< one per sphere
};

/// Spheres of proven protrusion `protrusion`, or less where a neighbour is near, whose union contains every
/// patch: a greedy choice among the balls of all patches, redundant ones removed (METHOD 1.3).
MedialSet medialSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                        const MedialOptions& options, const Progress& progress = {});

/// One ball a patch, slack close to 0 so that it touches the surface at the patch's centre, grown by
/// `protrusion`: plain shrinking balls. Covers the patches when they are fine enough, which fitPatches() sees
/// to.
MedialSet shrinkingSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                           const MedialOptions& options, const Progress& progress = {});

/// The balls inside (METHOD 1.4). Those with nothing left (features thinner than the slack) are points, so
/// that the union still comes as near to every point that was covered as the spheres stick out.
SphereSet inscribed(const MedialSet& set);

} // namespace tss
