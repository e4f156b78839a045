#pragma once
#include "bake/motion/ClosestPointQuery.h"

namespace tss {

/// For each vertex of a closed surface the vector from the medial surface to it: the radius of the largest
/// inscribed ball that touches there along the smoothed normal, both smoothed over the surface so that coarse
/// or rough meshes thicken evenly, and not less than by what fills the volume (METHOD 6.1). #V, scene units.
std::vector<Vec3> medialOffsets(const TriangleMesh& mesh, const ClosestPointQuery& locator,
                                const std::vector<Vec3>& normals);

} // namespace tss
