#include "bake/tool/ChoosePair.h"

#include "bake/base/Error.h"
#include "bake/model/SourceHash.h"

namespace tss::tool {

const Pair& choosePair(const SceneModel& scene, const std::string& path, const std::string& file) {
    if (path.empty() && scene.pairs.size() == 1) return scene.pairs[0];
    const int found = findPair(scene, path);
    if (found >= 0) return scene.pairs[found];
    std::string known;
    for (const Pair& pair : scene.pairs) known += (known.empty() ? "" : ", ") + pair.path;
    if (known.empty())
        throw InputError(Where{file, "", path}, "expected a pair of rigid bodies, the scene has none");
    throw InputError(Where{file, "", path}, "no such pair; expected --pair with one of: " + known);
}

const Pair& chooseFreshPair(const SceneModel& scene, const std::string& path, const std::string& file) {
    const Pair& pair = choosePair(scene, path, file);
    requireFresh(scene, pair, file);
    return pair;
}

} // namespace tss::tool
