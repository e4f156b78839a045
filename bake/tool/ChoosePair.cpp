#include "bake/tool/ChoosePair.h"

#include "bake/base/Error.h"
#include "bake/model/SourceHash.h"

namespace tss::tool {

const Pair& chooseFreshPair(const SceneModel& scene, const std::string& path, const std::string& file) {
    std::string known;
    for (const Pair& pair : scene.pairs) {
        if (pair.path == path || (path.empty() && scene.pairs.size() == 1)) {
            requireFresh(scene, pair, file);
            return pair;
        }
        known += (known.empty() ? "" : ", ") + pair.path;
    }
    if (known.empty())
        throw InputError(Where{file, "", path}, "expected a pair of rigid bodies, the scene has none");
    if (findSkin(scene, path) >= 0)
        throw InputError(Where{file, "", path}, "is a skin; expected a pair, one of: " + known);
    throw InputError(Where{file, "", path}, "no such pair; expected --pair with one of: " + known);
}

} // namespace tss::tool
