#pragma once
#include "bake/geometry/SurfacePart.h"

namespace tss::verify {

/// A direction along which two triangles that are apart are as far apart as they can be seen to be: across
/// the edges where an edge of each is nearest, from the one to the other else. Of length 1, or zero where it
/// cannot be told. Whoever uses it shows that it separates: nothing rests on it being the best.
Vec3 separatingAxis(const Corners& s, const Corners& t);

} // namespace tss::verify
