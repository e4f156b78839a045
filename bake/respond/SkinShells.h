#pragma once
#include "bake/respond/SkinShares.h"

namespace tss {

/// How a vertex of a shell without a seed is held.
struct ShellVertex {
    int round = -1;              ///< in which its shell was; -1: none, its skin has a seed
    std::uint32_t holder = 0;    ///< that it goes with where `weights` are 0
    Tri skin = Tri::Zero();      ///< the corners of the skin that it goes with, held in an earlier round
    Vec3 weights = Vec3::Zero(); ///< barycentric
    double distance = 0;         ///< to what it goes with, scene units
    double least = 0;            ///< the least distance of its shell
};

/// Shells that hang together with no seed, as clothes, helmets and shoes are: those nearest to what is held
/// come first, and each vertex goes with the nearest holder, or with the nearest skin that is held by then
/// where that is nearer; so shoes go with trousers and these with hips. nearestSeed: #V, how far it is along
/// the skin to a seed, infinite where there is none. Returns #V; empty where all skin has a seed.
std::vector<ShellVertex> heldShells(const TriangleMesh& skin, const std::vector<SkinHolder>& holders,
                                    const std::vector<double>& nearestSeed);

} // namespace tss
