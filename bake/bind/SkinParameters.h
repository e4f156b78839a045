#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/BoneChain.h"

#include <span>
#include <vector>

namespace tss {

/// How a skin behaves (METHOD 6.5).
struct SkinParameters {
    double stretchCompliance = 0; ///< of the elastic sheet, >= 0; at 1 it is half as stiff in stretch
    double bendCompliance = 0;    ///< of the elastic sheet, >= 0; at 1 it is half as stiff in bending
    /// #bodies: the moving frame that each is rigid in, -1: the skin's own. Empty: each bone is a frame of
    /// its own, muscles are in the skin's.
    std::vector<int> frames;
    /// #bodies: of a muscle over several bones bodies that move with those behind the first, in order to that
    /// of its insertion; the muscle's own frame is that of the bone at its origin. None for all others.
    /// Empty: none for all.
    std::vector<std::vector<int>> chains;
    /// #frames of #V in [0,1]: skinning weights; empty: computed from where the bones are.
    std::vector<std::vector<double>> shares;
    std::vector<BoneSwing> swings;   ///< sampled motions of the bodies, one per joint value and direction
    std::vector<BoneSwing> together; ///< where several joint values go to their limits at once: contacts are
                                     ///< sought on these too, shares do not depend on them
    std::vector<double> tether;      ///< #V in [0,1], how firmly a vertex keeps its rest position; empty: 0
    std::vector<double> attach;      ///< #V in [0,1], how firmly it follows the muscle below it; empty: 1
    bool selfContact = false;        ///< the skin collides with itself too: lip against lip, lid against lid
    int iterations = 60;             ///< most solver iterations for each time that contacts are queried, >= 1
};

inline std::span<const int> chainOf(const SkinParameters& parameters, std::size_t body) {
    return parameters.chains.empty() ? std::span<const int>() : parameters.chains[body];
}

constexpr int bodySteps = 16; ///< intervals of a muscle's activation range between tabulated surfaces

/// Throws InputError for parameters that makeSkinRig() would refuse over so many muscles and bones.
void checkSkin(const TriangleMesh& skin, std::size_t bodies, const SkinParameters& parameters);

} // namespace tss
