#pragma once
#include "bake/model/SceneModel.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// `tss make` of any number of bodies, joints, muscles and skins.
struct WholeSceneArguments {
    std::string output;
    double metersPerUnit = 1;
    std::vector<std::string> bodies, joints, skins, bones, muscles;
    std::vector<std::string> offsets; ///< see RobotFile
    std::string pairs = "all";
    std::string motion; ///< a CSV file, see applyMotion()
    std::string upAxis; ///< "Y" or "Z"; empty: that of the meshes
};

/// What to say where the meshes of the bodies are of so unlike size that one is in another unit; else empty.
std::string unlikeUnits(const SceneModel& scene);

/// Writes the scene and says what it holds. Throws InputError that quotes the option that is wrong.
void makeWholeScene(const WholeSceneArguments& arguments, const Console& console);

} // namespace tss::tool
