#include "bake/model/PairDofs.h"

namespace tss {

std::vector<JointDof> pairDofs(const SceneModel& scene, const Pair& pair) {
    std::vector<JointDof> dofs;
    int body = pair.bodyA;
    for (int index : pair.joints) {
        const Joint& joint = scene.joints[static_cast<std::size_t>(index)];
        const bool backwards = joint.body0 != body;
        for (std::size_t k = 0; k < joint.dofs.size(); ++k)
            dofs.push_back({index, backwards ? joint.dofs.size() - 1 - k : k});
        body = backwards ? joint.body0 : joint.body1;
    }
    return dofs;
}

} // namespace tss
