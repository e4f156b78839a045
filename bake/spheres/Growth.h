#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/TriangleMesh.h"
#include "bake/spheres/SphereOptions.h"
#include "bake/spheres/SphereSet.h"

#include <vector>

namespace tss {

/// A sphere of the growth.
struct GrownSphere {
    Sphere sphere;        ///< the last one before a fourth point, T_max or the threshold radius
    std::vector<int> met; ///< the triangle whose centroid is m1 and those met, in this order: 2 to 4
};

/// [paper] Grows the spheres of all triangles in their order (METHOD 1.1), without those that an earlier
/// sphere has met and those that met no second one.
std::vector<GrownSphere> growSpheres(const TriangleMesh& mesh, const GrowthOptions& options,
                                     const Progress& progress = {});

} // namespace tss
