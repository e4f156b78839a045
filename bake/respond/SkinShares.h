#pragma once
#include "bake/motion/PoseBlend.h"
#include "bake/respond/SkinGraph.h"

namespace tss {

/// What may carry skin: its distance to each vertex and how large it is.
struct SkinHolder {
    std::vector<double> distance;    ///< #V, >= 0, scene units
    double size = 0;                 ///< diagonal of its bounds, scene units; infinite: no size of its own
    std::vector<std::uint32_t> sure; ///< vertices that are its own, however far
    std::vector<char> apart;         ///< #V: skin that never begins what it holds; empty: none
};

/// Vertices that are each holder's beyond doubt: near to it and far from all others, or where there are too
/// few much nearer to it than to all others.
std::vector<std::vector<std::uint32_t>> seedsOf(const std::vector<SkinHolder>& holders);

/// How far the holders go, and how firmly vertices stay whatever their shares are.
struct SkinStrokes {
    std::vector<std::vector<DualPose>> motions; ///< of #holders or fewer each, since rest; others hold still
    std::span<const double> tether;             ///< #V in [0,1]; empty: 0
    bool asGiven = false;                       ///< motions go the way round that their quaternions say
    int rounds = 16;      ///< of solves, at most, each after what would be turned over was made stiffer:
    double stiffer = 1.2; ///< by this factor; what gets stiff slowly disturbs little around it
    /// A holder's end is its seed farthest from all others: it is held by so much at least, or the rounds
    /// end.
    double leastAtEnds = 0;
};

/// Which share of a vertex follows each holder (METHOD 6.5): #holders of #V, >= 0, all of a vertex 1
/// together. Whose a vertex is, is not a matter of the nearest: a closed upper lip lies on the lower teeth.
/// Vertices much nearer to one holder than to any other are its seeds; every other vertex is claimed by the
/// holder whose seeds are nearest along the skin; the claims are spread by a linear solve, softly where two
/// meet and where the shares would change too fast or a stroke would turn the skin over.
std::vector<std::vector<double>> claimedShares(const TriangleMesh& skin, const SkinGraph& graph,
                                               const std::vector<SkinHolder>& holders,
                                               const SkinStrokes& strokes = {});

/// Spreads values over the skin so that they change over lengths of `reach`, within their bounds. firmness:
/// #V, >= 1, how much more than usual a vertex keeps of its own value. values: lists of #V.
void spreadOver(const TriangleMesh& skin, const SkinGraph& graph, double reach,
                std::span<const double> firmness, std::vector<std::vector<double>>& values);

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
