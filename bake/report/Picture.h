#pragma once
#include "bake/model/SceneModel.h"

namespace tss::reporting {

/// A drawing of two bodies.
struct Picture {
    std::string caption;
    std::string png; ///< the file's bytes; what is not covered is transparent
};

/// The bodies of a pair where the joint rests and where its leading DOF is at either limit, all from the same
/// side: along the axis of a DOF that turns, else from the front.
std::vector<Picture> picturesOf(const SceneModel& scene, const Pair& pair, std::size_t leadingDof);

} // namespace tss::reporting
