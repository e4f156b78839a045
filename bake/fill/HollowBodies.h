#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/Solid.h"
#include "bake/motion/Motion.h"
#include "bake/spheres/SphereSet.h"

namespace tss {

/// One body of a pair as its spheres take it.
struct FilledBody {
    const Solid& solid;
    const MeshQuery& surface; ///< of the mesh alone, without closing fans
    const SphereSet& spheres;
    double protrusion; ///< of the spheres, scene units
};

/// Which of two bodies are hollow: cups or sheets, whose openings must not be closed as if there were
/// material behind them.
struct HollowBodies {
    bool a = false, b = false;
    explicit operator bool() const { return a || b; }
};

/// An open mesh may be a solid whose scan has holes, or a cup. The motion tells: where the other body reaches
/// inside while the surfaces are not near each other, there is no material. Looks for sampled poses of Q
/// (those of a sampled search, the rest pose first) at which spheres touch though the surfaces are farther
/// apart than `reach`, scene units, > 0. Only bodies with openings can be found hollow. Not a proof, unlike
/// findNested() for parts that stand inside as a whole. Stopped through progress, it has looked at fewer
/// poses.
HollowBodies findHollow(const FilledBody& a, const FilledBody& b, const Motion& motion, double reach,
                        const Progress& progress = {});

} // namespace tss
