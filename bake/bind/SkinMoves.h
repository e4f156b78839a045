#pragma once
#include "bake/bind/SkinParameters.h"
#include "bake/motion/MuscleDeformer.h"

#include <memory>

namespace tss {

/// How far muscles and bones move the vertices of a skin, as SkinSearchOptions expects it: #bodies of #V
/// each.
struct SkinMoves {
    std::vector<std::vector<double>> stray;  ///< bound of the displacement by other muscles, scene units
    std::vector<std::vector<double>> shares; ///< share of the body's motion in the vertex's; only the first
                                             ///< body of a frame has it
};
SkinMoves skinMoves(const TriangleMesh& skin,
                    const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                    const SkinParameters& parameters);

} // namespace tss
