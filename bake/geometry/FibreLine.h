#pragma once
#include "bake/geometry/TriangleMesh.h"

namespace tss {

/// The line that a muscle shortens along, found from its surface: from one end over the middles of `inner`
/// slices to the other. The ends are the two vertices that lie the farthest from each other over the surface;
/// a slice is where the ways to both have the same ratio, so that the line follows a muscle that bends. Of a
/// mesh in several components that of the largest. The same line for the same mesh; which end comes first has
/// no meaning. Throws InputError for a mesh without area.
std::vector<Vec3> fibreLine(const TriangleMesh& mesh, int inner = 7);

/// The same of a muscle that closes on itself: `points` middles of slices around the axis that it is open
/// along, that of least extent where several are; around that where none is, and fewer where a slice is
/// empty. Throws InputError for a mesh without area.
std::vector<Vec3> ringLine(const TriangleMesh& mesh, int points = 16);

} // namespace tss
