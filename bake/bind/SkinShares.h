#pragma once
#include "bake/bind/SkinClaims.h"
#include "bake/motion/PoseBlend.h"

namespace tss {

/// Motions that the shares have to suit: where one would fold the skin, shares are made to change more
/// slowly.
struct ShareOptions {
    std::vector<std::vector<DualPose>> motions; ///< since rest, each of the first influences; others rest
    std::span<const double> tether;             ///< #V in [0,1], see SkinParameters; empty: 0
    bool keepSigns = false;                     ///< see PoseBlend
    int maxRounds = 32; ///< at most so many further solves; before each, triangles that a motion would fold
                        ///< are made stiffer
};

/// Skinning weights (METHOD 6.3): #influences of #V, >= 0, sum 1 at each vertex. The nearest bone does not
/// tell whose a vertex is: a closed upper lip lies on the lower teeth. Each vertex is claimed by the
/// influence whose seeds are nearest along the skin; a linear solve diffuses the claims, softly where two
/// meet, and more where the shares would change too fast or a motion would fold the skin.
std::vector<std::vector<double>> claimedShares(const TriangleMesh& skin, const SkinGraph& graph,
                                               const std::vector<SkinInfluence>& influences,
                                               const ShareOptions& options = {});

/// A share without what is too little to move skin by: those below a thousandth become 0, others are lowered
/// continuously. share: in [0, 1].
double withoutLeast(double share);

/// Smooths given shares where a motion would fold the skin, and nowhere else, over `reach` and more, > 0,
/// scene units.
void unfoldShares(const TriangleMesh& skin, const SkinGraph& graph, double reach, const ShareOptions& options,
                  std::vector<std::vector<double>>& shares);

/// Smooths values over the skin by screened diffusion with a decay length of `reach`. firmness: #V, >= 1,
/// weight with which a vertex keeps its own value. values: lists of #V.
void spreadOver(const TriangleMesh& skin, const SkinGraph& graph, double reach,
                std::span<const double> firmness, std::vector<std::vector<double>>& values);

} // namespace tss
