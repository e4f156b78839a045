#pragma once
#include "bake/model/SceneModel.h"
#include "bake/spheres/SphereOptions.h"

namespace tss::tool {

struct SpheresWritten {
    std::string text;
    std::size_t links = 0, spheres = 0;
    std::vector<std::string> notes;
};

/// collision_spheres as cuRobo's robot files have them: of each rigid body with a mesh, in its own frame, in
/// metres. The union of a link's spheres holds its whole surface, and they stick out of it by what its
/// comment says, both proven. Throws InputError for a mesh that cannot be filled so closely.
SpheresWritten curoboSpheresOf(const SceneModel& scene, const SphereOptions& options);

} // namespace tss::tool
