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
Json sayScene(const MadeScene& made, const std::string& output, const Console& console);

/// Writes the scene of a robot to `output` and says what it holds. motion: a CSV file, see applyMotion(), or
/// empty. Throws InputError.
void makeRobot(const RobotFile& from, const std::string& motion, const std::string& output,
               const Console& console);

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

/// What "[NAME=]MESH" says on the command line; without NAME the file gives it.
struct NamedMesh {
    std::string name, file;
};
NamedMesh namedMesh(const std::string& text);

/// Adds the muscles, [NAME=]MESH[,from=BODY,to=BODY,contract=0.15,sheet|ring], and the skins, [NAME=]MESH,
/// over all muscles and the bones named, all bodies where none is, to a scene whose rigid bodies are the
/// links of a robot; notes what is odd about them. Throws InputError that quotes the option.
void addSoftBodies(RobotScene& made, const Robot& robot, const WholeSceneArguments& arguments,
                   const Console& console);

} // namespace tss::tool
