#pragma once
#include "bake/respond/SkinRig.h"

namespace tss {

/// What muscles and bones do to the vertices of a skin, as SkinSearchOptions wants it: one list a body, #V
/// each.
struct SkinMoves {
    std::vector<std::vector<double>> stray;  ///< how far the contraction of the others may move the vertex
    std::vector<std::vector<double>> shares; ///< of the body's motion that the vertex makes; bodies of one
                                             ///< frame have it once
};
SkinMoves skinMoves(const TriangleMesh& skin,
                    const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                    const SkinParameters& parameters);

} // namespace tss
