#include "bake/spheres/MedialSpheres.h"

#include "bake/spheres/PatchCover.h"

#include <algorithm>

namespace tss {

MedialSet medialSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                        const MedialOptions& options, const Progress& progress) {
    const PatchOptions patchOptions{protrusion, options.slackFactor, options.sizeFactor, options.mostPatches,
                                    options.neighbour.get()};
    FittedPatches fitted = fitPatches(solid, patches, patchOptions, progress);
    const CoverSets sets = coverSets(fitted.candidates, fitted.patches, progress);
    // Stopped there, all candidates are the cover that there is.
    if (sets.spheres.empty()) return {std::move(fitted.candidates), std::move(fitted.inner)};
    MedialSet set;
    for (const std::uint32_t i : greedyCover(sets, fitted.patches.size())) {
        set.spheres.push_back(fitted.candidates[i]);
        set.inner.push_back(fitted.inner[i]);
    }
    report(progress, "spheres that cover", 1);
    return set;
}

MedialSet shrinkingSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                           const MedialOptions& options, const Progress& progress) {
    const PatchOptions patchOptions{protrusion, std::min(options.slackFactor, 1e-3), 1, options.mostPatches,
                                    options.neighbour.get()};
    FittedPatches fitted = fitPatches(solid, patches, patchOptions, progress);
    return {std::move(fitted.candidates), std::move(fitted.inner)};
}

SphereSet inscribed(const MedialSet& set) {
    SphereSet spheres = set.spheres;
    for (std::size_t i = 0; i < spheres.size(); ++i) spheres[i].radius = set.inner[i];
    return spheres;
}

} // namespace tss
