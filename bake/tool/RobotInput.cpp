#include "bake/tool/RobotInput.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Words.h"
#include "bake/pipeline/FirstLook.h"
#include "bake/robot/MeshFiles.h"
#include "bake/robot/ReadRig.h"
#include "bake/robot/ReadRobot.h"
#include "bake/scene/SceneLayer.h"
#include "bake/scene/Utf8.h"
#include "bake/tool/DofSpec.h"
#ifdef OSGTSS_HAVE_USDA
#include "bake/usd/Stage.h"
#include "bake/usd/UsdRobot.h"
#endif

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace tss::tool {

namespace {

/// The name of an XML text's first element; empty where it has none, or is no text.
std::string rootName(const std::string& text) {
    if (!isText(text)) return "";
    for (auto at = text.find('<'); at != text.npos; at = text.find('<', at + 1)) {
        if (text.compare(at, 4, "<!--") == 0) {
            at = text.find("-->", at);
            if (at == text.npos) return "";
        } else if (text[at + 1] != '?' && text[at + 1] != '!') {
            return text.substr(at + 1, text.find_first_of(" \t\r\n/>", at) - at - 1);
        }
    }
    return "";
}

Robot readRobot(const RobotFile& from, [[maybe_unused]] const std::string& text,
                [[maybe_unused]] const FindMesh& find) {
    const std::string root = rootName(text);
    const bool mujoco = root == "mujoco";
    if (!root.empty() && !mujoco && root != "robot")
        throw InputError(Where{from.input},
                         "expected the <robot> of a URDF or the <mujoco> of an MJCF, found <" + root + ">" +
                             (root == "mujocoinclude" ? ", a part of one: take the file that includes it"
                              : root == "sdf" ? ", of Gazebo; sdf2mjcf of gz-mujoco makes an MJCF of it"
                                              : ""));
    if (mujoco) {
#ifdef OSGTSS_HAVE_MJCF
        return readMjcf(text, from.input, [&](const std::string& name) { return readWholeFile(find(name)); });
#endif
    } else {
#ifdef OSGTSS_HAVE_URDF
        return readUrdf(text, from.input);
#endif
    }
    throw InputError(Where{from.input},
                     std::string("this build reads no ") +
                         (mujoco ? "MJCF (OSGTSS_MJCF is off)" : "URDF (OSGTSS_URDF is off)"));
}

Robot readRobot(const RobotFile& from, const FindMesh& find) {
    Robot robot = readRobot(from, readWholeFile(from.input), find);
#ifdef OSGTSS_HAVE_URDF
    if (!from.srdf.empty()) readSrdf(robot, readWholeFile(from.srdf), from.srdf);
#endif
    moveLinks(robot, from.offsets);
    return robot;
}

#ifdef OSGTSS_HAVE_USDA

MadeScene sceneOfOurs(const UsdStage& stage, const std::string& file) {
    MadeScene made;
    made.notes = stage.notes;
    try {
        made.scene = readScene(stage.layer, file);
    } catch (const InputError& error) { // a JSON pointer says nothing of a text that is none
        throw InputError(Where{error.where.file, "", error.where.path}, error.message);
    }
    for (const Body& body : made.scene.bodies) made.links.push_back({body.path, 1, false});
    made.distances = distancesAtRest(made.scene);
    return made;
}

/// The scene of a `.usda`: as it stands there where it is one of this software, else that of the robot that
/// its UsdPhysics describes. Its files may lie in the folders of the packages too.
MadeScene readUsdScene(const std::string& file, const Packages& packages, const RobotSceneRequest& request,
                       const std::vector<std::string>& offsets) {
    const OpenUsd open = besideUsd(meshesOf(file, packages));
    const UsdFile first = inFile(file, [&] { return open(std::filesystem::absolute(file).string()); });
    if (!first.missing.empty()) throw InputError(Where{file}, first.missing);
    UsdStage stage = readStage(first.text, file, open);
    if (stage.ours && !offsets.empty())
        throw InputError(Where{file}, "is a scene of osgTSS already; --offset is for one to make");
    if (stage.ours) return sceneOfOurs(stage, file);
    const FindMesh none = [](const std::string& name) -> std::string { return name; };
    Robot robot = robotOf(std::move(stage), file);
    moveLinks(robot, offsets);
    return newScene(robot, request, none);
}

#else

MadeScene readUsdScene(const std::string& file, const Packages&, const RobotSceneRequest&,
                       const std::vector<std::string>&) {
    throw InputError(Where{file}, "this build reads no USD (OSGTSS_USDA is off)");
}

#endif

/// The pairs of a character, a scene with skins: see pairForAnimation(), also for what cannot be one.
void pairBones(RobotScene& made, bool near) {
    SceneModel& scene = made.scene;
    const PairsLeftOut leftOut = pairForAnimation(scene, near);
    std::vector<std::pair<int, int>> unmade;
    for (const AllPairs::Unmade& none : made.unmade) unmade.emplace_back(none.bodyA, none.bodyB);
    const std::vector<MotionContact> contacts = contactsInMotion(scene, unmade);
    std::size_t next = 0;
    std::erase_if(made.unmade, [&](const AllPairs::Unmade& none) {
        const MotionContact& contact = contacts[next++];
        return areBones(scene, none.bodyA, none.bodyB) && (contact.holds() || (near && !contact.near));
    });
    if (!leftOut.held.empty())
        made.notes.push_back(
            "no pair: bones that the animation has in each other half of the time or more, by "
            "which they would be held: " +
            firstOf(leftOut.held, 10));
    if (leftOut.far > 0)
        made.notes.push_back(fmt::format(
            "left out: {} of bones that the animation never has nearer to each other than a ninth "
            "of the smaller one's size; --pairs all keeps them",
            counted(leftOut.far, "pair")));
}

} // namespace

MadeScene newScene(const Robot& robot, const RobotSceneRequest& request, const FindMesh& find) {
    MadeScene made{sceneOf(robot, request, find), {}};
    if (!robot.skins.empty()) pairBones(made, request.pairs == RobotPairs::Near);
    const std::size_t told = std::min<std::size_t>(made.unmade.size(), 10);
    for (std::size_t k = 0; k < told; ++k) made.notes.push_back("no pair: " + made.unmade[k].note);
    if (made.unmade.size() > told)
        made.notes.push_back(fmt::format("no pair: {} more for such reasons", made.unmade.size() - told));
    made.distances = distancesAtRest(made.scene);
    setFirstTolerances(made.scene, made.distances);
    return made;
}

int linkCalled(const Robot& robot, const std::string& name, const std::string& option) {
    std::string known;
    for (std::size_t i = 0; i < robot.links.size(); ++i) {
        if (robot.links[i].name == name) return static_cast<int>(i);
        known += (known.empty() ? "" : ", ") + robot.links[i].name;
    }
    throw InputError(option + ": no body is called \"" + name + "\"; expected one of " + known);
}

void moveLinks(Robot& robot, const std::vector<std::string>& offsets) {
    for (const std::string& text : offsets) {
        const std::string option = "--offset " + text;
        const auto sign = text.rfind('=');
        if (sign == text.npos) throw InputError(option + ": expected LINK=X,Y,Z");
        const int link = linkCalled(robot, text.substr(0, sign), option);
        const Vec3 by = parseVector(text.substr(sign + 1), option);
        const auto joint = std::ranges::find(robot.joints, link, &RobotJoint::child);
        if (joint == robot.joints.end())
            throw InputError(option + ": expected a link that moves; no joint holds this one");
        moveChild(*joint, by);
    }
}

std::array<CLI::Option*, 2> addRobotFileOptions(CLI::App& command, RobotFile& file) {
    return {command
                .add_option("--package", file.packages,
                            "NAME=DIR: the folder of package://NAME/...; repeat. Else it is looked for "
                            "upwards from the file. NAME=: left out by name. Other paths, and those of a "
                            ".usda, may lead into these folders too")
                ->allow_extra_args(false),
            command.add_option("--srdf", file.srdf, "an SRDF: pairs that it switches off are left out")};
}

bool isUsd(const std::string& file) {
    const std::string extension = fileExtension(file);
    return extension == ".usda" || extension == ".usd" || extension == ".usdc" || extension == ".usdz";
}

bool isRobot(const std::string& file) {
    const std::string extension = fileExtension(file);
    if (extension == ".urdf" || extension == ".mjcf" || extension == ".xacro") return true;
    if (extension != ".xml") return false;
    const std::string root = rootName(readWholeFile(file));
    return root == "robot" || root == "mujoco";
}

namespace {

/// The scene of a rigged character in a mesh file.
MadeScene readRigScene(const RobotFile& from, const RobotSceneRequest& request) {
    RigFile rig = readRigFile(from.input);
    if (!from.animation.empty()) takeAnimations(rig, readRigFile(from.animation), from.animation);
    Robot robot = rigRobot(rig, from.input);
    if (from.metersPerUnit > 0) robot.metersPerUnit = from.metersPerUnit;
    if (from.upAxis != '\0') robot.upAxis = from.upAxis;
    const double stated = rig.notes.metersPerUnit;
    if (stated > 0 && std::abs(stated - robot.metersPerUnit) > 1e-5 * stated)
        robot.notes.push_back(
            fmt::format("the file says that one of its units, as it is read, is {:.6g} m", stated));
    if (!(stated > 0) && !(from.metersPerUnit > 0))
        robot.notes.push_back("the file does not say how long its unit is: 1 m is taken; --meters-per-unit");
    if (rig.notes.upAxis == '\0' && from.upAxis == '\0')
        robot.notes.push_back("the file does not say which way is up: Z is taken; --up-axis Y");
    if (rig.animations.empty())
        robot.notes.push_back(
            "the file has no animation that would move its bones; --motion FILE takes those "
            "of another file");
    moveLinks(robot, from.offsets);
    const FindMesh none = [](const std::string& name) -> std::string { return name; };
    return newScene(robot, request, none);
}

} // namespace

MadeScene readRobotScene(const RobotFile& from) {
    if (isMeshName(from.input) && !isRigName(from.input))
        throw InputError(Where{from.input},
                         "is a mesh; expected a robot's file, or two meshes as --a and --b");
    if (from.input.ends_with(".tss"))
        throw InputError(Where{from.input}, "is a scene already; expected a robot's file");
    RobotSceneRequest request;
    request.visual = from.geometry == "visual";
    if (from.pairs != "near") request.pairs = from.pairs == "all" ? RobotPairs::All : RobotPairs::Neighbours;
    if (isRigName(from.input)) {
        if (!from.srdf.empty()) throw CLI::ValidationError("--srdf", "is for URDF and MJCF");
        return readRigScene(from, request);
    }
    const Packages packages = parsePackages(from.packages);
    if (isUsd(from.input)) {
        if (!from.srdf.empty())
            throw CLI::ValidationError("--srdf",
                                       "is for URDF and MJCF; a .usda says itself which pairs are filtered");
        return readUsdScene(from.input, packages, request, from.offsets);
    }
    const FindMesh find = meshesOf(from.input, packages);
    const Robot robot = readRobot(from, find);
    return inFile(from.input, [&] { return newScene(robot, request, find); });
}

} // namespace tss::tool
