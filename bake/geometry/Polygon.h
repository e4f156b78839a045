#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <span>
#include <vector>

namespace tss {

/// A polygon cut into triangles of its corners, two fewer than it has, which turn as it does and together
/// have its border: whatever it is bounded by, the surface has no hole where it was. One that is flat and
/// does not cross itself is exactly covered, also where it is concave, has corners in a line, or goes into a
/// hole and back along one edge. A convex one is the fan about its first corner. No triangle for fewer than
/// three corners; which ones where a corner is not finite is left open. Takes the square of their number,
/// mostly.
std::vector<Tri> triangulated(std::span<const Vec3> corners);

} // namespace tss
