#pragma once
#include "bake/base/Progress.h"
#include "bake/model/SceneModel.h"
#include "bake/verify/MeshVerify.h"

#include <cstdint>

namespace tss {

/// What re-proving one pair of a baked scene gave.
struct PairVerdict {
    std::string reason;             ///< what does not hold, in words; empty: all that is claimed holds
    std::vector<double> pose;       ///< DOF values that break it, radians and units of value; may be empty
    std::vector<std::string> notes; ///< what is not proven, or only under a condition, in words
    std::uint64_t cells = 0;        ///< of Q that the proof took
    double band = 0;                ///< rounding granted, scene units
    MeshVerdict meshes;
    std::size_t spheresA = 0, spheresB = 0; ///< made when it was baked, as the file says
    bool holds() const { return reason.empty(); }
};

/// Proves again, with the code of bake/verify, what a pair's table or proof states: that it is not stale, and
/// from the file and the meshes alone what it says of the meshes (MeshVerify.h). A table that states a gap,
/// down to a depth or up to a margin, is proven to keep it against all spheres, which are made again from the
/// meshes by the baker's own code. A pair with neither table nor proof, or with a table made from samples,
/// does not hold. Throws InputError for a pair whose meshes or motion cannot be used.
PairVerdict verifyPair(const SceneModel& scene, const Pair& pair, const Progress& progress = {});

} // namespace tss
