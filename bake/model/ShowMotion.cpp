#include "bake/model/ShowMotion.h"

namespace tss {

void addShowMotion(SceneModel& scene, const std::set<std::size_t>& others) {
    const double codes = 2 * scene.timeCodesPerSecond;
    double start = scene.startTimeCode;
    for (std::size_t j = 0; j < scene.joints.size(); ++j) {
        if (others.contains(j)) continue;
        Joint& joint = scene.joints[j];
        joint.drives.resize(joint.dofs.size());
        for (std::size_t k = 0; k < joint.dofs.size(); ++k, start += codes) {
            const Dof& dof = joint.dofs[k];
            joint.drives[k] = {{start, start + codes / 4, start + codes * 3 / 4, start + codes},
                               {dof.rest, dof.lower, dof.upper, dof.rest}};
        }
    }
    for (MuscleModel& muscle : scene.muscles) {
        muscle.activation = {{start, start + codes / 2, start + codes}, {0, 1, 0}};
        start += codes;
    }
    scene.endTimeCode = start;
}

} // namespace tss
