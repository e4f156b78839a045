#pragma once
#include "bake/verify/MeshProof.h"
#include "bake/verify/PieceShapes.h"

#include <optional>

namespace tss::verify {

struct PiecePair {
    Piece a, b;
};

/// Where a sphere of A contains a piece of its surface, one of B another, and the two are a test, that test
/// fires wherever the pieces meet: at every pose, with nothing to be known of the motion. Of a table that
/// asks nearly all pairs of its spheres these are nearly all pairs of pieces. Returns the pairs that are left
/// to be shown, which together with those are all of both surfaces; nothing where they are too many to list.
std::optional<std::vector<PiecePair>> pairsNotHeld(const SurfaceTree& a, const SurfaceTree& b,
                                                   const MeshClaim& claim);

} // namespace tss::verify
