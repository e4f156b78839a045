#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// The line that a muscle shortens along, found from the mesh of its surface: of a ring its closed line, else
/// from the end that is nearer to the bone that it rides on, which stays, to the other. Throws InputError for
/// a mesh without area.
std::vector<Vec3> findFibre(const SceneModel& scene, const MuscleModel& muscle);

} // namespace tss
