#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// Whether a pair has more than three joint values, as those of a whole arm have: the default's spheres are
/// then more than a first look is worth.
bool isLongChain(const SceneModel& scene, const Pair& pair);

/// The tolerance for a first look at such pairs: a thirtieth of the usual body, of one digit in millimetres.
/// Scene units.
double firstTolerance(const SceneModel& scene);

/// The budget with which to search all pairs of a scene takes some minutes: seconds per pair.
double firstBudget(const SceneModel& scene);

} // namespace tss
