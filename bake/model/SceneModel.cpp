#include "bake/model/SceneModel.h"

#include <algorithm>

namespace tss {

namespace {

template <class Items>
int indexOf(const Items& items, const std::string& path) {
    const auto found = std::ranges::find(items, path, &Items::value_type::path);
    return found == items.end() ? -1 : static_cast<int>(found - items.begin());
}

} // namespace

int findBody(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.bodies, path);
}

int findPair(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.pairs, path);
}

int findMuscle(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.muscles, path);
}

int findSkin(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.skins, path);
}

bool hasPath(const SceneModel& scene, const std::string& path) {
    return indexOf(scene.bodies, path) >= 0 || indexOf(scene.joints, path) >= 0 ||
           indexOf(scene.muscles, path) >= 0 || indexOf(scene.pairs, path) >= 0;
}

double largestDiagonal(const SceneModel& scene) {
    double largest = 0;
    for (const Body& body : scene.bodies)
        if (!body.mesh.vertices.empty()) largest = std::max(largest, diagonal(body.mesh));
    return largest;
}

std::string primName(const std::string& path) {
    return path.substr(path.rfind('/') + 1);
}

std::vector<UnderSkin> underSkin(const SceneModel& scene, const SkinModel& skin) {
    std::vector<UnderSkin> under;
    for (const int index : skin.muscles) {
        const MuscleModel& muscle = scene.muscles.at(static_cast<std::size_t>(index));
        under.push_back({index, muscle.body, muscle.bone, -1});
    }
    for (const int bone : skin.bones) under.push_back({-1, bone, bone, -1});
    for (const int joint : skin.weights.joints)
        if (std::ranges::find(skin.bones, joint) == skin.bones.end()) under.push_back({-1, -1, joint, -1});
    for (std::size_t m = 0; m < skin.muscles.size(); ++m) {
        const int bone = scene.muscles[skin.muscles[m]].insertionBone;
        if (bone < 0) continue;
        const auto moves = [&](const UnderSkin& u) { return u.bone == bone; };
        auto found = std::ranges::find_if(under, moves);
        if (found == under.end()) found = under.insert(under.end(), UnderSkin{-1, -1, bone, -1});
        under[m].insertion = static_cast<int>(found - under.begin());
    }
    return under;
}

const std::string& pathOf(const SceneModel& scene, const UnderSkin& under) {
    return under.muscle >= 0 ? scene.muscles[under.muscle].path : scene.bodies[under.bone].path;
}

} // namespace tss
