#pragma once
#include "bake/model/SceneModel.h"

#include <string>

namespace tss::tool {

/// The pair of this prim path, or the only one of the scene when the path is empty. Throws InputError that
/// names the file and the pairs there are, and where its table was made for another scene.
const Pair& chooseFreshPair(const SceneModel& scene, const std::string& path, const std::string& file);

} // namespace tss::tool
