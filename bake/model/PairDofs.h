#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// A degree of freedom of a scene: the joint, and which of its own.
struct JointDof {
    int joint = -1;
    std::size_t dof = 0;
};

/// Which of the joints' DOFs each DOF of pairMotion() is: those of a joint that is crossed from body1 to
/// body0 come in reverse order.
std::vector<JointDof> pairDofs(const SceneModel& scene, const Pair& pair);

} // namespace tss
