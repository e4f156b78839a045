#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/spheres/SphereOptions.h"
#include "bake/spheres/SphereSet.h"

namespace tss {

/// [paper] One sphere per vertex, in the order of the vertices (METHOD 1.2). Its radius is that of the rule;
/// conservative: at least 1/sqrt(3) of the longest edge of every triangle at the vertex, with which the union
/// contains the surface (every point of a triangle is that near to a corner). Vertices in no triangle have
/// none.
SphereSet surfaceSpheres(const TriangleMesh& mesh, const SurfaceOptions& options, bool conservative);

} // namespace tss
