#pragma once
#include "bake/robot/RobotScene.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// A robot's file, and how it is read.
struct RobotFile {
    std::string input;                 ///< URDF, MJCF or .usda
    std::vector<std::string> packages; ///< "NAME=DIR"
    std::string srdf;                  ///< a file; empty: none
    std::string geometry = "collision", pairs = "all";
};

/// --package and --srdf.
std::array<CLI::Option*, 2> addRobotFileOptions(CLI::App& command, RobotFile& file);

/// The name is that of a file of USD, .usda or a form that is refused.
bool isUsd(const std::string& file);

/// A file that describes a robot, by its name, an .xml by its first element: URDF or MJCF.
bool isRobot(const std::string& file);

/// The scene of a robot. Throws InputError, also where this build has no reader for it.
RobotScene readRobotScene(const RobotFile& from);

} // namespace tss::tool
