#pragma once
#include "bake/tool/Command.h"

namespace tss::tool {

/// `tss make` of any number of bodies, joints, muscles and skins.
struct WholeSceneArguments {
    std::string output;
    double metersPerUnit = 1;
    std::vector<std::string> bodies, joints, skins, bones, muscles;
    std::string pairs = "all";
    std::string motion; ///< a CSV file, see applyMotion()
    std::string upAxis; ///< "Y" or "Z"; empty: that of the meshes
};

/// Writes the scene and says what it holds. Throws InputError that quotes the option that is wrong.
void makeWholeScene(const WholeSceneArguments& arguments, const Console& console);

} // namespace tss::tool
