#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/Solid.h"
#include "bake/spheres/SphereMethods.h"

#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

namespace tss {

/// Medial spheres of whole bodies, kept from pair to pair: over many joint values every pair of a body asks
/// for spheres of all of its surface. For any number of threads, one at a time, and as long as the meshes
/// stay what they are.
class WholeFits {
public:
    /// patient: where given, the progress by which all are made, whatever those who ask have time for: what
    /// they have none for the next ones find.
    explicit WholeFits(Progress patient = {}) : patient_(std::move(patient)) {}

    /// What medialSpheres() makes of all patches of a solid that no neighbour binds; with a protrusion above
    /// a hundredth of its diagonal the balls are grown from those found for a finer one, no finer than half
    /// of it. body: its prim path. Throws TooFine, and InputError where it is stopped.
    const MedialSet& spheres(const std::string& body, const Solid& solid, double protrusion,
                             const MedialOptions& options, const Progress& progress);

private:
    using Key = std::tuple<std::string, bool, double>; ///< prim path, whether hollow, protrusion
    const Progress patient_;
    std::mutex one_;
    std::map<Key, FittedPatches> patches_;
    std::map<Key, MedialSet> sets_;
};

} // namespace tss
