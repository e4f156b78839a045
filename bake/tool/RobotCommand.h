#pragma once
#include "bake/robot/RobotScene.h"
#include "bake/tool/Command.h"

namespace tss::tool {

/// `tss make` from a robot's file.
struct RobotArguments {
    std::string input, output;
    std::vector<std::string> packages;
    std::string srdf, geometry = "collision", pairs = "all";
    std::string motion; ///< a CSV file, see applyMotion()
};

/// Says what the scene holds that was written: meshes, joints, notes, what comes next. Returns it as data.
Json sayScene(const RobotScene& made, const std::string& output, const Console& console);

/// Writes the scene of a robot and says what it holds. Throws InputError.
void makeRobot(const RobotArguments& arguments, const Console& console);

} // namespace tss::tool
