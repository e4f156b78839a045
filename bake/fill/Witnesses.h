#pragma once
#include "bake/geometry/Solid.h"

#include <vector>

namespace tss {

/// A point that shows where a connected part of a body is: a vertex of it (radius 0), or the centre of a ball
/// that the part encloses. The part is not inside a solid that the point is outside of, nor one in which the
/// ball does not fit there.
struct Witness {
    Vec3 centre;
    double radius = 0; ///< scene units
};

/// Witnesses of one connected part: balls inside it, the largest first, then the vertices farthest out in 26
/// directions, then others spread over the part.
using PartWitnesses = std::vector<Witness>;

/// Those of each connected part of a surface (geometry/ConnectedParts.h). Parts with openings have no balls.
std::vector<PartWitnesses> witnessesOf(const TriangleMesh& mesh);

} // namespace tss
