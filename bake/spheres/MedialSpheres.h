#pragma once
#include "bake/spheres/Patches.h"
#include "bake/spheres/SphereOptions.h"

namespace tss {

/// Spheres of proven protrusion `protrusion` whose union contains every patch: a greedy choice among the
/// balls of all patches, redundant ones removed (METHOD 1.3).
SphereSet medialSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                        const MedialOptions& options, const Progress& progress = {});

/// One ball a patch, slack close to 0 so that it touches the surface at the patch's centre, grown by
/// `protrusion`: plain shrinking balls. Covers the patches when they are fine enough, which fitPatches() sees
/// to.
SphereSet shrinkingSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                           const MedialOptions& options, const Progress& progress = {});

/// The spheres with radii less by `protrusion`: inside the solid where they were found inside (METHOD 1.4).
/// Those with nothing left (features thinner than the slack) become points, so that the union still comes
/// within `protrusion` of every point that was covered.
SphereSet inscribed(SphereSet spheres, double protrusion);

} // namespace tss
