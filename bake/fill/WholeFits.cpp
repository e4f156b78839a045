#include "bake/fill/WholeFits.h"

#include "bake/base/Error.h"

#include <cmath>

namespace tss {

namespace {

/// The protrusion for which balls are found that are grown to this one: the next lower of nine tenths of a
/// power of two.
double grownFrom(double protrusion) {
    return 0.9 * std::exp2(std::floor(std::log2(protrusion / 0.9)));
}

} // namespace

const MedialSet& WholeFits::spheres(const std::string& body, const Solid& solid, double protrusion,
                                    const MedialOptions& options, const Progress& progress) {
    const std::lock_guard lock(one_);
    const Key key{body, solid.hollow(), protrusion};
    if (const auto known = sets_.find(key); known != sets_.end()) return known->second;
    bool stopped = false;
    const Progress asked = [&](std::string_view step, double done) {
        stopped = stopped || !report(patient_ ? patient_ : progress, step, done);
        return !stopped;
    };
    MedialSet made;
    if (protrusion > solid.diagonal() / 100) {
        const double base = grownFrom(protrusion);
        const Key baseKey{body, solid.hollow(), base};
        if (!patches_.contains(baseKey))
            patches_[baseKey] =
                fitPatchesSparsely(solid, patchesOf(solid.mesh()), {base, options.mostPatches}, asked);
        FittedPatches grown = patches_[baseKey];
        for (std::size_t i = 0; i < grown.candidates.size(); ++i)
            grown.candidates[i].radius = grown.inner[i] + protrusion;
        made = chooseSpheres(grown, asked);
    } else {
        made = medialSpheres(solid, patchesOf(solid.mesh()), protrusion, options, asked);
    }
    if (stopped) throw InputError("stopped before the spheres were made");
    return sets_[key] = std::move(made);
}

} // namespace tss
