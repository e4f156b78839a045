#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <vector>

namespace tss {

/// How a muscle thickens when it shortens: about its fibre line, or about its medial surface (METHOD 6.1). A
/// ring's fibre line is closed: it narrows towards its middle, in its own plane, and thickens about its line.
enum class MuscleForm { Tube, Sheet, Ring };

/// A muscle that shortens along its fibre and keeps its volume (METHOD 6.1). All in one frame, that of its
/// surface.
struct Muscle {
    TriangleMesh surface;    ///< closed, at activation 0
    std::vector<Vec3> fibre; ///< polyline from origin to insertion, at least 2 points; of a ring once round,
                             ///< at least 3, the first not again at the end
    MuscleForm form = MuscleForm::Tube;
    bool spans = false; ///< it lies over two or more bones, so that it deforms even where it never contracts
    std::vector<double> chainShares; ///< #V in [0, 1], place along its bones, see BoneChain.h; empty: rising
                                     ///< along the fibre as its shortening does, of a ring from 0 at its
                                     ///< first point to 1 half way round
    std::vector<Eigen::Vector4d> sides; ///< see ChainBlend
    double anchor =
        0; ///< fraction along the fibre that stays where it is: 0 origin, 1 insertion; not of a ring
    double maxContraction = 0.2; ///< greatest shortening, as a fraction of the fibre's chord, of a ring's
                                 ///< length, at activation 1
    double activationLower = 0;  ///< activations explored when baking and accepted at run time
    double activationUpper = 1;
};

} // namespace tss
