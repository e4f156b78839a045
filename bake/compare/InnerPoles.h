#pragma once
#include "bake/spheres/SphereSet.h"

#include <span>

namespace tss::compare {

/// For each surface point, given with an outward normal of any length, the largest Delaunay ball that touches
/// it and whose centre lies on the inner side: its inner pole, a point of the medial axis (Amenta and Bern
/// 1999). Radius 0 where there is none. The points differ from each other. One per point.
SphereSet innerPoles(std::span<const Vec3> places, std::span<const Vec3> normals);

} // namespace tss::compare
