#pragma once
#include "bake/geometry/TriangleMesh.h"

namespace tss {

struct Sphere {
    Vec3 centre; ///< scene units, in the body's own frame
    double radius = 0;
};

/// The spheres that stand for one body (the paper's Ms).
using SphereSet = std::vector<Sphere>;

} // namespace tss
