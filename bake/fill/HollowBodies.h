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

/// Which of two bodies are hollow: cups or sheets, whose openings may not be closed and filled as if there
/// were material behind them.
struct HollowBodies {
    bool a = false, b = false;
    explicit operator bool() const { return a || b; }
};

/// An open mesh may be a bone whose scan has holes or a cup; the mesh does not tell, but the motion does:
/// where the other body stands inside without the surfaces being near each other, there is no material.
/// Looks at poses over all of Q (those of a sampled search, the rest pose first) at which spheres touch
/// though the surfaces are farther apart than `reach`, > 0; only bodies with openings can be hollow. Poses
/// between those are not looked at: not a proof, as findNested() is for what stands inside as a whole. Asked
/// to stop, it has looked at fewer.
HollowBodies findHollow(const FilledBody& a, const FilledBody& b, const Motion& motion, double reach,
                        const Progress& progress = {});

} // namespace tss
