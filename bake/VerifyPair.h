#pragma once
#include "bake/base/Progress.h"
#include "bake/scene/SceneModel.h"

#include <cstdint>

namespace tss {

/// What re-proving one pair of a baked scene gave.
struct PairVerdict {
    std::string reason;       ///< what does not hold, in words; empty: all holds
    std::vector<double> pose; ///< DOF values that break it, radians and units of value; may be empty
    std::size_t spheresA = 0, spheresB = 0; ///< that the table answers for
    std::uint64_t cells = 0;                ///< of Q that the proof took
    double band = 0;                        ///< rounding granted, scene units
    double early = -1; ///< how far the table's spheres stick out together, plus epsilon; -1: not asked for
    bool holds() const { return reason.empty(); }
};

/// Proves again, with the code of bake/verify, what a pair's table or proof states: that the table is not
/// stale, that it answers as all spheres do at every pose, and how far its spheres stick out of the meshes.
/// That the spheres cover the contact zone follows from making them again from the meshes; it is not proven
/// by other code. A pair with neither table nor proof, or with one made from samples, does not hold. Throws
/// InputError for a pair whose spheres cannot be made again.
PairVerdict verifyPair(const SceneModel& scene, const Pair& pair, const Progress& progress = {});

} // namespace tss
