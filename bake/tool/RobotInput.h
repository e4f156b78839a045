#pragma once
#include "bake/robot/RobotScene.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// A robot's file, and how it is read.
struct RobotFile {
    std::string input;                 ///< URDF, MJCF, .usda, or a rigged character of a mesh format
    std::string animation;             ///< a file whose animations are the character's; empty: its own
    std::vector<std::string> packages; ///< "NAME=DIR"
    std::string srdf;                  ///< a file; empty: none
    std::vector<std::string> offsets;  ///< "LINK=X,Y,Z", see moveLinks()
    std::string geometry = "collision", pairs = "near";
    double metersPerUnit = 0; ///< of a character; 0: what its file states
    char upAxis = '\0';       ///< the same, 'Y' or 'Z'
};

/// The link of that name. Throws InputError that quotes the option and names all there are.
int linkCalled(const Robot& robot, const std::string& name, const std::string& option);

/// Moves links, with what hangs on them: "LINK=X,Y,Z", in the link's own frame, units of the robot. Throws
/// InputError.
void moveLinks(Robot& robot, const std::vector<std::string>& offsets);

/// --package and --srdf.
std::array<CLI::Option*, 2> addRobotFileOptions(CLI::App& command, RobotFile& file);

/// The name is that of a file of USD, .usda or a form that is refused.
bool isUsd(const std::string& file);

/// A file that describes a robot, by its name, an .xml by its first element: URDF or MJCF.
bool isRobot(const std::string& file);

/// The scene of a robot, and how far apart the meshes of its pairs are at rest, see distancesAtRest().
struct MadeScene : RobotScene {
    std::vector<double> distances;
};

/// sceneOf(), its pairs with the tolerances of a first look.
MadeScene newScene(const Robot& robot, const RobotSceneRequest& request, const FindMesh& find);

/// The scene of a robot. Throws InputError, also where this build has no reader for it.
MadeScene readRobotScene(const RobotFile& from);

} // namespace tss::tool
