#pragma once
#include "bake/bind/SkinGraph.h"
#include "bake/motion/PoseBlend.h"

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

/// Motions that the shares have to suit: where one would fold the skin, shares are made to change more
/// slowly.
struct ShareOptions {
    std::vector<std::vector<DualPose>> motions; ///< since rest, each of the first influences; others rest
    std::span<const double> tether;             ///< #V in [0,1], see SkinParameters; empty: 0
    bool keepSigns = false;                     ///< see PoseBlend
    int maxRounds = 16;      ///< at most so many further solves; before each, triangles that a motion would
                             ///< fold are made stiffer
    double stiffening = 1.2; ///< by this factor; a small one changes little of the skin around
    /// In [0, 1]. The end of an influence is its seed that is farthest from the seeds of all others. A round
    /// that would bring the influence's share there below this is dropped, and is the last one.
    double leastAtEnds = 0;
};

/// Skinning weights (METHOD 6.3): #influences of #V, >= 0, sum 1 at each vertex. The nearest bone does not
/// tell whose a vertex is: a closed upper lip lies on the lower teeth. Each vertex is claimed by the
/// influence whose seeds are nearest along the skin; a linear solve diffuses the claims, softly where two
/// meet, and more where the shares would change too fast or a motion would fold the skin.
std::vector<std::vector<double>> claimedShares(const TriangleMesh& skin, const SkinGraph& graph,
                                               const std::vector<SkinInfluence>& influences,
                                               const ShareOptions& options = {});

/// Smooths given shares, over `reach` and more, where a motion would fold the skin, and nowhere else.
void unfoldShares(const TriangleMesh& skin, const SkinGraph& graph, double reach, const ShareOptions& options,
                  std::vector<std::vector<double>>& shares);

/// Smooths values over the skin by screened diffusion with a decay length of `reach`. firmness: #V, >= 1,
/// weight with which a vertex keeps its own value. values: lists of #V.
void spreadOver(const TriangleMesh& skin, const SkinGraph& graph, double reach,
                std::span<const double> firmness, std::vector<std::vector<double>>& values);

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

} // namespace tss
