#pragma once
#include "bake/tool/Command.h"
#include "bake/tool/RobotInput.h"

namespace tss::tool {

/// "21 mm x 3 mm x 8 mm", of a size in scene units.
std::string sizeText(const Vec3& size, double metersPerUnit);

/// Whether something is larger than a house or smaller than a grain: it is mostly in another unit than was
/// said.
bool isOddSize(double metres);

/// Says what the scene holds that was written: meshes, joints, notes, what comes next. Returns it as data.
Json sayScene(const RobotScene& made, const std::string& output, const Console& console);

/// Writes the scene of a robot to `output` and says what it holds. motion: a CSV file, see applyMotion(), or
/// empty. Throws InputError.
void makeRobot(const RobotFile& from, const std::string& motion, const std::string& output,
               const Console& console);

} // namespace tss::tool
