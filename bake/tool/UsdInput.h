#pragma once
#include "bake/robot/MeshFiles.h"

namespace tss::tool {

/// The name is that of a file of USD, .usda or a form that is refused.
bool isUsd(const std::string& file);

/// The scene of a `.usda`: as it stands there where it is one of this software, else that of the robot that
/// its UsdPhysics describes. Its files may lie in the folders of the packages too. Throws InputError, also
/// where this build has no reader.
RobotScene readUsdScene(const std::string& file, const Packages& packages, const RobotSceneRequest& request);

} // namespace tss::tool
