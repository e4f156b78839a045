#include "bake/model/CheckIndices.h"

#include "bake/base/Error.h"

namespace tss {

namespace {

/// Throws when an index that this prim has is not one of the items; -1 is when `orNone`.
template <class Items>
void check(const std::string& path, const std::string& what, const Items& items,
           const std::vector<int>& indices, bool orNone = false) {
    for (const int index : indices) {
        if (index >= (orNone ? -1 : 0) && index < static_cast<int>(items.size())) continue;
        throw InputError({{}, {}, path}, "expected the index of a " + what + " of the scene, which has " +
                                             std::to_string(items.size()) + " of them, found " +
                                             std::to_string(index));
    }
}

} // namespace

void checkIndices(const SceneModel& scene) {
    for (const Joint& joint : scene.joints)
        check(joint.path, "body", scene.bodies, {joint.body0, joint.body1}, true);
    for (const Pair& pair : scene.pairs) {
        check(pair.path, "body", scene.bodies, {pair.bodyA, pair.bodyB});
        check(pair.path, "joint", scene.joints, pair.joints);
    }
    for (const MuscleModel& muscle : scene.muscles) {
        check(muscle.path, "body", scene.bodies, {muscle.body});
        check(muscle.path, "body", scene.bodies, {muscle.bone, muscle.insertionBone}, true);
    }
    for (const SkinModel& skin : scene.skins) {
        check(skin.path, "body", scene.bodies, {skin.body});
        check(skin.path, "muscle", scene.muscles, skin.muscles);
        check(skin.path, "body", scene.bodies, skin.bones);
        check(skin.path, "body", scene.bodies, skin.weights.joints);
    }
}

} // namespace tss
