#pragma once
#include "bake/model/SceneModel.h"

#include <vector>

namespace tss {

/// Whether a pair has more than three joint values, as pairs of a whole arm do: spheres of the default
/// tolerance then take too long for a first look.
bool isLongChain(const SceneModel& scene, const Pair& pair);

/// How far apart the meshes of each pair are where the joints rest, scene units: 0 where they touch or
/// overlap, infinity where a body has no mesh.
std::vector<double> distancesAtRest(const SceneModel& scene);

/// A thirtieth of the median body diagonal, rounded to one digit in millimetres; scene units.
double usualTolerance(const SceneModel& scene);

/// The tolerance for a first look at such pairs, scene units: the usual one, but no more than three tenths of
/// the distance of any two meshes at rest, so that the spheres of both bodies together leave some of it.
/// Pairs whose surfaces are shown within ten seconds of processor time to stay apart do not count: they need
/// no spheres. Nor do those for which it would be less than a hundredth of the usual one.
double firstTolerance(const SceneModel& scene, const std::vector<double>& distancesAtRest);

/// The budget, seconds per pair, with which baking all pairs of a scene takes some minutes.
double firstBudget(const SceneModel& scene);

} // namespace tss
