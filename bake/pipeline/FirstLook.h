#pragma once
#include "bake/model/SceneModel.h"

#include <vector>

namespace tss {

/// Whether a pair has more than three joint values, as pairs of a whole arm do: spheres of the default
/// tolerance then take too long for a first look.
bool isLongChain(const SceneModel& scene, const Pair& pair);

/// How far apart the meshes of each pair are where the joints rest, scene units: 0 where they touch or
/// overlap, infinity where a body has no mesh. From a ninth of the smaller body's diagonal on it is only no
/// more than that, which is quick: room beyond makes no tolerance of setFirstTolerances() another.
std::vector<double> distancesAtRest(const SceneModel& scene);

/// Of each pair the share of so many poses of the scene's motion, evenly spaced in time, at which the
/// surfaces of its bodies cross.
std::vector<double> sharesCrossing(const SceneModel& scene, int poses);

/// A thirtieth of the median body diagonal, rounded to one digit in millimetres; scene units.
double usualTolerance(const SceneModel& scene);

/// Where some pair is a long chain: gives each pair the tolerance of a first look, a length with its unit, as
/// its setting. About a thirtieth of the diagonal of its smaller body (toleranceNextTo()). A hundredth where
/// the two touch or overlap at rest, for what is near that is exempt; and of pairs that are no long chains no
/// more than three tenths of their distance at rest, so that the spheres of both leave their joint some of
/// it. None is finer than what a bake takes by itself, a 500th.
void setFirstTolerances(SceneModel& scene, const std::vector<double>& distancesAtRest);

/// The budget, seconds per pair, with which baking all pairs of a scene takes some minutes.
double firstBudget(const SceneModel& scene);

} // namespace tss
