#include "bake/model/Kinematics.h"

namespace tss {

Pose jointPose(const Joint& joint, std::span<const double> values) {
    Pose pose = joint.frame0;
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) pose = pose * dofPose(joint.dofs[k], values[k]);
    return pose * joint.frame1.inverse(Eigen::Isometry);
}

std::vector<Pose> posedBodies(const SceneModel& scene, std::span<const double> values) {
    std::vector<Pose> placements;
    for (const Body& body : scene.bodies) placements.push_back(body.placement);
    std::vector<bool> placed(scene.bodies.size(), true);
    for (const Joint& joint : scene.joints)
        if (joint.enabled && joint.body1 >= 0) placed[joint.body1] = false;

    for (bool again = true; again;) { // outwards along the joints, however they are ordered in the file
        again = false;
        std::size_t first = 0;
        for (const Joint& joint : scene.joints) {
            const auto own = values.subspan(first, joint.dofs.size());
            first += joint.dofs.size();
            const bool ready = joint.body0 < 0 || placed[joint.body0];
            if (!joint.enabled || joint.body1 < 0 || placed[joint.body1] || !ready) continue;
            const Pose parent = joint.body0 < 0 ? Pose::Identity() : placements[joint.body0];
            placements[joint.body1] = parent * jointPose(joint, own);
            placed[joint.body1] = true;
            again = true;
        }
    }
    return placements;
}

} // namespace tss
