#pragma once
#include "bake/bind/SkinParameters.h"
#include "bake/motion/MuscleDeformer.h"

#include <memory>

namespace tss {

/// How muscles and bones move the vertices of a skin, as SkinSearchOptions expects it. Both are #bodies lists
/// of #V.
struct SkinMoves {
    std::vector<std::vector<double>> stray;  ///< at most how far all other muscles displace the vertex from
                                             ///< its path with this one, scene units
    std::vector<std::vector<double>> shares; ///< how much of the body's motion the vertex makes, in [0, 1];
                                             ///< of bodies in one frame the first alone has shares
};
/// skin: the mesh, scene units. bodies: the muscles and bones below it, in its frame.
SkinMoves skinMoves(const TriangleMesh& skin,
                    const std::vector<std::shared_ptr<const MuscleDeformer>>& bodies,
                    const SkinParameters& parameters);

} // namespace tss
