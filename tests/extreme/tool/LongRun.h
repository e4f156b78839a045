#pragma once
#include "bake/model/SceneModel.h"

namespace extreme {

/// A joint that is driven through its contact and back, again and again.
struct ToAndFro {
    long steps = 0, blocked = 0;
    double drift =
        0; ///< largest difference of a step from the same step of the second round, radians or units
    double deepest = 0; ///< smallest gap met, scene units
};

/// The first pair of a baked scene, from its lower limits to its upper and back in rounds of 48 steps.
ToAndFro driveToAndFro(const tss::SceneModel& scene, long steps);

/// A skin through a great many frames.
struct ManyFrames {
    long frames = 0;
    double creep = 0;      ///< largest difference of a vertex in the last round from the third, scene units
    double size = 0;       ///< diagonal of the skin, scene units
    long growth = 0;       ///< resident bytes at the end less those after the third round
    double slowdown = 0;   ///< time of the last rounds over that of the early ones, medians
    double subnormals = 0; ///< share of positions and normals, of the last round, that are subnormal
};

/// The first skin of a baked scene; its muscles tighten and let go in rounds of 50 frames. rest: whether they
/// let go all the way, where the skin starts afresh.
ManyFrames playFrames(const tss::SceneModel& scene, long frames, bool rest);

} // namespace extreme
