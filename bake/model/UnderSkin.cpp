#include "bake/model/SceneModel.h"

#include <algorithm>

namespace tss {

std::vector<UnderSkin> underSkin(const SceneModel& scene, const SkinModel& skin) {
    std::vector<UnderSkin> under;
    for (const int index : skin.muscles) {
        const MuscleModel& muscle = scene.muscles.at(static_cast<std::size_t>(index));
        under.push_back({index, muscle.body, muscle.bone});
    }
    for (const int bone : skin.bones) under.push_back({-1, bone, bone});
    for (const int joint : skin.weights.joints)
        if (std::find(skin.bones.begin(), skin.bones.end(), joint) == skin.bones.end())
            under.push_back({-1, -1, joint});
    return under;
}

} // namespace tss
