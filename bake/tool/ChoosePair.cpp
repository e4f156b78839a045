#include "bake/tool/ChoosePair.h"

#include "bake/base/Error.h"

namespace tss::tool {

const Pair& choosePair(const SceneModel& scene, const std::string& path, const std::string& file) {
    if (path.empty() && scene.pairs.size() == 1) return scene.pairs[0];
    const int found = findPair(scene, path);
    if (found >= 0) return scene.pairs[found];
    std::string known;
    for (const Pair& pair : scene.pairs) known += (known.empty() ? "" : ", ") + pair.path;
    throw InputError(Where{file, "", path}, "no such pair; expected --pair with one of: " + known);
}

} // namespace tss::tool
