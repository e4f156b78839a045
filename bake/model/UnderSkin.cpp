#include "bake/model/UnderSkin.h"

#include "bake/model/JointGraph.h"
#include "bake/model/Kinematics.h"

#include <algorithm>

namespace tss {

std::vector<UnderSkin> underSkin(const SceneModel& scene, const SkinModel& skin) {
    std::vector<UnderSkin> under;
    for (const int index : skin.muscles) {
        const MuscleModel& muscle = scene.muscles.at(static_cast<std::size_t>(index));
        under.push_back({index, muscle.body, muscle.bone, {}});
    }
    for (const int bone : skin.bones) under.push_back({-1, bone, bone, {}});
    for (const int joint : skin.weights.joints)
        if (std::ranges::find(skin.bones, joint) == skin.bones.end()) under.push_back({-1, -1, joint, {}});
    for (std::size_t m = 0; m < skin.muscles.size(); ++m)
        for (const int bone : muscleChain(scene, scene.muscles[skin.muscles[m]])) {
            auto found = std::ranges::find(under, bone, &UnderSkin::bone);
            if (found == under.end()) found = under.insert(under.end(), UnderSkin{-1, -1, bone, {}});
            under[m].chain.push_back(static_cast<int>(found - under.begin()));
        }
    return under;
}

const std::string& pathOf(const SceneModel& scene, const UnderSkin& under) {
    return under.muscle >= 0 ? scene.muscles[under.muscle].path : scene.bodies[under.bone].path;
}

std::vector<int> muscleChain(const SceneModel& scene, const MuscleModel& muscle) {
    const int first = muscle.bone, last = muscle.insertionBone;
    if (last < 0) return {};
    const auto joints = first < 0 ? std::nullopt : findChain(scene.joints, first, last);
    if (!joints || joints->size() < 2) return {last};
    const std::vector<int> roots = rigidRoots(scene);
    const auto hasMesh = [&](int body) {
        return std::ranges::any_of(movingAsOne(scene, body),
                                   [&](int k) { return !scene.bodies[k].mesh.empty(); });
    };
    if (!hasMesh(first) || !hasMesh(last)) return {last};
    std::vector<int> chain;
    int body = first, root = roots[first];
    for (const int index : *joints) {
        const Joint& joint = scene.joints[index];
        body = joint.body0 == body ? joint.body1 : joint.body0;
        if (body < 0 || roots[body] == root || roots[body] == roots[last] || !hasMesh(body)) continue;
        chain.push_back(body);
        root = roots[body];
    }
    chain.push_back(last);
    return chain;
}

} // namespace tss
