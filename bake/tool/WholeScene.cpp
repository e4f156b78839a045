#include "bake/tool/MakeScene.h"

#include "bake/base/Error.h"
#include "bake/geometry/Import.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/model/AddPair.h"
#include "bake/model/Kinematics.h"
#include "bake/scene/Layer.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/DofSpec.h"
#include "bake/tool/FreeingAdvice.h"
#include "bake/tool/SceneMotion.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace tss::tool {

namespace {

/// NAME=PARENT,CHILD:DOF[;DOF...][;offset:X,Y,Z]
RobotJoint parseJoint(const Robot& robot, const std::string& text, double metersPerUnit) {
    const std::string option = "--joint " + text;
    const auto sign = text.find('='), comma = text.find(',', sign), colon = text.find(':', comma);
    if (sign == text.npos || comma == text.npos || colon == text.npos)
        throw InputError(option + ": expected NAME=PARENT,CHILD:DOF[;DOF...][;offset:X,Y,Z]");
    RobotJoint joint;
    joint.name = text.substr(0, sign);
    if (!isPrimName(joint.name))
        throw InputError(option + ": expected a name of letters, digits and _, found \"" + joint.name + "\"");
    joint.where = option;
    joint.parent = linkCalled(robot, text.substr(sign + 1, comma - sign - 1), option);
    joint.child = linkCalled(robot, text.substr(comma + 1, colon - comma - 1), option);
    if (joint.parent == joint.child) throw InputError(option + ": expected two bodies");
    const std::string offset = "offset:";
    Vec3 moved = Vec3::Zero();
    for (const std::string& part : split(text.substr(colon + 1), ';')) {
        if (part.starts_with(offset)) {
            moved += parseVector(part.substr(offset.size()), option);
            continue;
        }
        joint.dofs.push_back(parseDof(part, metersPerUnit));
        joint.dofs.back().name.clear();
    }
    // The DOFs are as the parent has them, also where the child is moved first.
    moveChild(joint, moved);
    return joint;
}

/// As asked for; else Y where all meshes are glTF, whose Y is up, and Z.
char upAxisOf(const WholeSceneArguments& arguments) {
    if (!arguments.upAxis.empty()) return arguments.upAxis[0];
    bool all = true;
    for (const auto* texts : {&arguments.bodies, &arguments.skins})
        for (const std::string& text : *texts) all = all && isGltf(namedMesh(text).file);
    return all ? 'Y' : 'Z';
}

/// Bodies that no joint moves stand still, each on the first of them: what moves is paired with all.
void fixStanding(Robot& robot) {
    int first = -1;
    for (int link = 0; link < static_cast<int>(robot.links.size()); ++link) {
        if (std::ranges::find(robot.joints, link, &RobotJoint::child) != robot.joints.end()) continue;
        if (first < 0) {
            first = link;
            continue;
        }
        RobotJoint joint;
        joint.name = robot.links[link].name + "_still";
        joint.where = "--body " + robot.links[link].name;
        joint.parent = first;
        joint.child = link;
        robot.joints.push_back(std::move(joint));
    }
}

Robot robotOf(const WholeSceneArguments& arguments) {
    Robot robot;
    robot.name = std::filesystem::path(arguments.output).stem().string();
    robot.metersPerUnit = arguments.metersPerUnit;
    robot.upAxis = upAxisOf(arguments);
    for (const std::string& text : arguments.bodies) {
        const NamedMesh named = namedMesh(text);
        for (const RobotLink& link : robot.links)
            if (link.name == named.name)
                throw InputError("--body " + text + ": another body is called " + named.name +
                                 "; give it a name, NAME=" + named.file);
        RobotLink link;
        link.name = named.name;
        link.collision.emplace_back().file = named.file;
        robot.links.push_back(link);
    }
    for (const std::string& text : arguments.joints) {
        RobotJoint joint = parseJoint(robot, text, arguments.metersPerUnit);
        if (std::ranges::any_of(robot.joints, [&](const auto& other) { return other.name == joint.name; }))
            throw InputError("--joint " + text + ": another joint is called " + joint.name);
        robot.joints.push_back(std::move(joint));
    }
    moveLinks(robot, arguments.offsets);
    fixStanding(robot);
    settleRobot(robot);
    return robot;
}

} // namespace

std::string unlikeUnits(const SceneModel& scene) {
    double least = 0, most = 0;
    std::string small, large;
    for (const Body& body : scene.bodies) {
        if (body.mesh.empty()) continue;
        const double size = diagonal(body.mesh);
        if (small.empty() || size < least) least = size, small = body.path;
        if (large.empty() || size > most) most = size, large = body.path;
    }
    if (most <= 300 * least) return "";
    return fmt::format("{} is {:.3g} times as large as {}; are their meshes in the same unit?", large,
                       most / least, small);
}

void makeWholeScene(const WholeSceneArguments& arguments, const Console& console) {
    const Robot robot = robotOf(arguments);
    RobotSceneRequest request;
    request.pairs = arguments.pairs == "neighbours" ? RobotPairs::Neighbours : RobotPairs::All;
    MadeScene made = newScene(robot, request, [](const std::string& name) { return name; });
    addSoftBodies(made, robot, arguments, console);
    if (const std::string text = unlikeUnits(made.scene); !text.empty()) made.notes.push_back(text);
    if (arguments.motion.empty())
        addShowMotion(made.scene);
    else
        applyMotion(made.scene, arguments.motion);
    saveScene(made.scene, arguments.output);
    Json result = sayScene(made, arguments.output, console);
    std::vector<const Pair*> tied;
    for (const Pair& pair : made.scene.pairs)
        if (tiesDirectly(made.scene, pair)) tied.push_back(&pair);
    for (const Pair* const pair : tied)
        for (Json& move : adviseMoves(made.scene, *pair, tied.size(), console)) {
            move["pair"] = pair->path;
            result["freeingMoves"].push_back(std::move(move));
        }
    console.print(result);
}

} // namespace tss::tool
