#pragma once
#include "bake/geometry/Solid.h"

#include <vector>

namespace tss {

/// A point of a connected part of a body with a ball about it that the part encloses, radius 0 on the
/// surface. The part is not inside a solid that the point is outside of, nor where the ball does not fit.
struct Witness {
    Vec3 centre;
    double radius = 0;
};

/// Witnesses of one connected part: balls inside it, the largest first, then the vertices farthest out in 26
/// directions, then others spread over the part.
using PartWitnesses = std::vector<Witness>;

/// Those of each connected part of a surface (geometry/ConnectedParts.h). Parts with openings have no balls.
std::vector<PartWitnesses> witnessesOf(const TriangleMesh& mesh);

} // namespace tss
