#pragma once
#include "bake/bind/SkinGraph.h"

namespace tss {

/// Something that skin may follow, a bone above all.
struct SkinInfluence {
    std::vector<double> distance;       ///< #V, its distance from each vertex, >= 0, scene units
    double size = 0;                    ///< diagonal of its bounds, scene units; infinite: no size of its own
    std::vector<std::uint32_t> certain; ///< vertices that belong to it whatever their distance
    std::vector<char> excluded; ///< #V: the vertex may not be one of its seeds; empty: none is excluded
};

/// The seeds of each influence, vertices that certainly follow it: near to it and far from all others, or,
/// where those are too few, much nearer to it than to all others.
std::vector<std::vector<std::uint32_t>> seedsOf(const std::vector<SkinInfluence>& influences);

/// What a vertex of a shell is bound to: an influence, or a point of other skin. A shell is a connected
/// component of the skin without a seed, such as a shoe.
struct ShellVertex {
    int round = -1;              ///< in which its shell is bound, from 0; -1: it is not of a shell
    std::uint32_t influence = 0; ///< what it is bound to if `weights` are 0
    Tri skin = Tri::Zero();      ///< else: corners of the triangle of the skin, bound in an earlier round
    Vec3 weights = Vec3::Zero(); ///< barycentric, in that triangle
    double distance = 0;         ///< to what it is bound to, scene units
    double least = 0;            ///< least distance of all vertices of its shell
};

/// Binds shells such as clothes, helmets and shoes, in rounds, the nearest ones first: each vertex to the
/// nearest influence, or to skin bound in an earlier round where that is nearer. So shoes follow trousers,
/// and these hips. nearestSeed: #V, distance along the skin to a seed, infinite where none is reached.
/// Returns #V; empty where there are no shells.
std::vector<ShellVertex> bindShells(const TriangleMesh& skin, const std::vector<SkinInfluence>& influences,
                                    const std::vector<double>& nearestSeed);

/// Whose each vertex is by distance along the skin, and how firmly.
struct SkinClaims {
    std::vector<std::uint32_t> influence; ///< #V: which one claims it
    std::vector<double> weight; ///< #V: firmness, area over squared distance times certainty, without a unit
    std::vector<double> size;   ///< #V: of the smaller of the two influences that meet here, scene units
    std::vector<ShellVertex> shells; ///< #V; empty where there are no shells
};

SkinClaims claimSkin(const TriangleMesh& skin, const SkinGraph& graph,
                     const std::vector<SkinInfluence>& influences);

} // namespace tss
