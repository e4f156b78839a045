#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/motion/Motion.h"

#include <optional>

namespace tss {

/// That two surfaces never meet, shown without a single sphere.
struct SurfacesApart {
    double clearance = 0;    ///< they stay farther apart than this at every pose of Q, scene units, > 0
    std::uint64_t cells = 0; ///< of Q that showed it
};

/// Branch and bound over Q: a cell is settled where the surfaces are farther apart at its centre than they may
/// move in it (METHOD 2.2). The clearance is half of the least distance or more. Nothing where they come nearer
/// than `touching` to each other, and where that many cells would be needed that other ways are quicker: this
/// is for joints whose parts stand close all the way round, which would take very fine spheres.
/// touching: see touchingDistance(). The same for any number of threads.
std::optional<SurfacesApart> surfacesApart(const MeshQuery& a, const MeshQuery& b, const Motion& motion,
                                           double touching, const Progress& progress = {});

} // namespace tss
