#pragma once
#include "bake/model/SceneModel.h"

#include <vector>

namespace tss {

/// Whether a pair has more than three joint values, as those of a whole arm have: the default's spheres are
/// then more than a first look is worth.
bool isLongChain(const SceneModel& scene, const Pair& pair);

/// How far apart the meshes of each pair are where the joints rest, scene units: 0 where they touch or
/// overlap, infinity where a body has no mesh.
std::vector<double> distancesAtRest(const SceneModel& scene);

/// A thirtieth of the usual body, of one digit in millimetres, scene units.
double usualTolerance(const SceneModel& scene);

/// The tolerance for a first look at such pairs: the usual one, and no more than three tenths of what meshes
/// are apart at rest: spheres of both bodies stick out, and together they are to leave some of the room. Not
/// of meshes that are seen, within some seconds, to stay apart: their proof needs no spheres.
double firstTolerance(const SceneModel& scene, const std::vector<double>& distancesAtRest);

/// The budget with which to search all pairs of a scene takes some minutes: seconds per pair.
double firstBudget(const SceneModel& scene);

} // namespace tss
