#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// Whether a pair has more joint values than this. Of those of a whole arm, more than three, the default's
/// spheres are more than a first look is worth; where somebody waits for a picture, of three.
bool isLongChain(const SceneModel& scene, const Pair& pair, std::size_t most);

/// The tolerance for a first look at such pairs: a thirtieth of the usual body, of one digit in millimetres.
/// Scene units.
double firstTolerance(const SceneModel& scene);

/// The budget with which to search all pairs of a scene takes some minutes: seconds per pair.
double firstBudget(const SceneModel& scene);

} // namespace tss
