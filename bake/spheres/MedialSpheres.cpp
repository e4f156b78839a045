#include "bake/spheres/MedialSpheres.h"

#include "bake/spheres/Cover.h"

#include <algorithm>

namespace tss {

SphereSet medialSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                        const MedialOptions& options, const Progress& progress) {
    const PatchOptions patchOptions{protrusion, options.slackFactor, options.sizeFactor, options.mostPatches};
    const FittedPatches fitted = fitPatches(solid, patches, patchOptions, progress);
    const CoverSets sets = coverSets(fitted.candidates, fitted.patches, progress);
    // Stopped there, all candidates are the cover that there is.
    if (sets.spheres.empty()) return fitted.candidates;
    SphereSet spheres;
    for (const std::uint32_t i : greedyCover(sets, fitted.patches.size()))
        spheres.push_back(fitted.candidates[i]);
    report(progress, "spheres that cover", 1);
    return spheres;
}

SphereSet shrinkingSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                           const MedialOptions& options, const Progress& progress) {
    const PatchOptions patchOptions{protrusion, std::min(options.slackFactor, 1e-3), 1, options.mostPatches};
    return fitPatches(solid, patches, patchOptions, progress).candidates;
}

SphereSet inscribed(SphereSet spheres, double protrusion) {
    for (Sphere& s : spheres) s.radius = std::max(0.0, s.radius - protrusion);
    return spheres;
}

} // namespace tss
