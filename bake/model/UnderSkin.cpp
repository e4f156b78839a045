#include "bake/model/SceneModel.h"

#include <algorithm>

namespace tss {

std::vector<UnderSkin> underSkin(const SceneModel& scene, const SkinModel& skin) {
    std::vector<UnderSkin> under;
    for (const int index : skin.muscles) {
        const MuscleModel& muscle = scene.muscles.at(static_cast<std::size_t>(index));
        under.push_back({index, muscle.body, muscle.bone, -1});
    }
    for (const int bone : skin.bones) under.push_back({-1, bone, bone, -1});
    for (const int joint : skin.weights.joints)
        if (std::find(skin.bones.begin(), skin.bones.end(), joint) == skin.bones.end())
            under.push_back({-1, -1, joint, -1});
    for (std::size_t m = 0; m < skin.muscles.size(); ++m) {
        const int bone = scene.muscles[static_cast<std::size_t>(skin.muscles[m])].insertionBone;
        if (bone < 0) continue;
        const auto moves = [&](const UnderSkin& u) { return u.bone == bone; };
        auto found = std::find_if(under.begin(), under.end(), moves);
        if (found == under.end()) found = under.insert(under.end(), UnderSkin{-1, -1, bone, -1});
        under[m].insertion = static_cast<int>(found - under.begin());
    }
    return under;
}

} // namespace tss
