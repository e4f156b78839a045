#include "bake/model/CheckIndices.h"

#include "bake/base/Error.h"

namespace tss {

namespace {

/// Looks at the indices of one prim.
class Indices {
public:
    Indices(const SceneModel& scene, const std::string& path) : scene_(scene), path_(path) {}

    void body(int index) const { expect(index, 0, scene_.bodies.size(), "body"); }
    void bodyOrNone(int index) const { expect(index, -1, scene_.bodies.size(), "body"); }
    void bodies(const std::vector<int>& indices) const {
        for (const int index : indices) body(index);
    }
    void joints(const std::vector<int>& indices) const {
        for (const int index : indices) expect(index, 0, scene_.joints.size(), "joint");
    }
    void muscles(const std::vector<int>& indices) const {
        for (const int index : indices) expect(index, 0, scene_.muscles.size(), "muscle");
    }

private:
    void expect(int index, int least, std::size_t count, const std::string& what) const {
        if (index >= least && index < static_cast<int>(count)) return;
        throw InputError({{}, {}, path_}, "expected the index of a " + what + " of the scene, which has " +
                                              std::to_string(count) + " of them, found " +
                                              std::to_string(index));
    }

    const SceneModel& scene_;
    const std::string& path_;
};

} // namespace

void checkIndices(const SceneModel& scene) {
    for (const Joint& joint : scene.joints) {
        const Indices of(scene, joint.path);
        of.bodyOrNone(joint.body0);
        of.bodyOrNone(joint.body1);
    }
    for (const Pair& pair : scene.pairs) {
        const Indices of(scene, pair.path);
        of.body(pair.bodyA);
        of.body(pair.bodyB);
        of.joints(pair.joints);
    }
    for (const MuscleModel& muscle : scene.muscles) {
        const Indices of(scene, muscle.path);
        of.body(muscle.body);
        of.bodyOrNone(muscle.bone);
        of.bodyOrNone(muscle.insertionBone);
    }
    for (const SkinModel& skin : scene.skins) {
        const Indices of(scene, skin.path);
        of.body(skin.body);
        of.muscles(skin.muscles);
        of.bodies(skin.bones);
        of.bodies(skin.weights.joints);
    }
}

} // namespace tss
