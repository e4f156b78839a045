#include "bake/model/SceneModel.h"

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

} // namespace tss
