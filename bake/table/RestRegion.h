#pragma once
#include "bake/geometry/SurfacePart.h"

#include <vector>

namespace tss {

/// Where the meshes of two jointed bodies overlap at rest: the parts of their surfaces between which contact
/// is exempt (METHOD 2.4). Contact of a part of `a` with a part of `b` is exempt; of either with anything
/// else it counts. Empty where the meshes are apart at rest, and where no exception is made.
struct RestRegion {
    std::vector<SurfacePart> a, b; ///< sorted, none twice and none inside another
    double depth = -1; ///< these parts touch when their spheres are deeper in each other than this, scene
                       ///< units; < 0: never (they are left out)

    bool empty() const { return a.empty() && b.empty(); }
};

} // namespace tss
