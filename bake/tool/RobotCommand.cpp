#include "bake/tool/RobotCommand.h"

#include "bake/BakeOptions.h"
#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/robot/MeshFiles.h"
#include "bake/robot/RobotScene.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/DofSpec.h"
#ifdef OSGTSS_HAVE_URDF
#include "bake/robot/ReadUrdf.h"
#endif

#include <filesystem>
#include <fmt/format.h>

namespace tss::tool {

namespace {

Robot readRobot(const RobotArguments& arguments) {
    const std::string text = readWholeFile(arguments.input);
    Robot robot;
#ifdef OSGTSS_HAVE_URDF
    robot = readUrdf(text, arguments.input);
    if (!arguments.srdf.empty()) readSrdf(robot, readWholeFile(arguments.srdf), arguments.srdf);
    return robot;
#endif
    throw InputError(Where{arguments.input, "", ""}, "this build reads no URDF (OSGTSS_URDF is off)");
}

Json sayLinks(const RobotScene& made, const Console& console) {
    Json links = Json::array();
    for (std::size_t i = 0; i < made.links.size(); ++i) {
        const LinkReport& link = made.links[i];
        const Body& body = made.scene.bodies[i];
        const std::string name = body.path.substr(body.path.rfind('/') + 1);
        Json json = {{"body", body.path}, {"shapes", link.shapes}, {"triangles", body.mesh.triangles.size()}};
        if (body.mesh.empty()) {
            console.say(name + ": no geometry");
        } else {
            const Vec3 size = bounds(body.mesh).sizes();
            const auto length = [&](int axis) { return lengthText(size[axis], made.scene.metersPerUnit); };
            const MeshAudit audit = auditMesh(body.mesh);
            console.say(fmt::format("{}: {}{}\n  {} x {} x {}", name, text(audit),
                                    link.shapes > 1 ? fmt::format(" ({} shapes as one)", link.shapes) : "",
                                    length(0), length(1), length(2)));
            json["watertight"] = audit.watertight;
            json["sizeMm"] = {1000 * size.x(), 1000 * size.y(), 1000 * size.z()};
        }
        links.push_back(json);
    }
    return links;
}

/// A link larger than a house or smaller than a grain: its meshes are mostly in another unit.
void remarkSizes(const SceneModel& scene, const Console& console) {
    for (const Body& body : scene.bodies) {
        const double size = body.mesh.empty() ? 0 : bounds(body.mesh).diagonal().norm();
        if (size > 10 || (size > 0 && size < 1e-3))
            console.say(
                fmt::format("note: {} is {} long; are its meshes in metres? Where they are not, their <mesh> "
                            "needs a scale",
                            body.path, lengthText(size, 1)));
    }
}

} // namespace

void makeRobot(const RobotArguments& arguments, const Console& console) {
    const FindMesh find = meshesOf(arguments.input, parsePackages(arguments.packages));
    const Robot robot = readRobot(arguments);
    RobotSceneRequest request;
    request.visual = arguments.geometry == "visual";
    request.pairs = arguments.pairs == "all" ? RobotPairs::All : RobotPairs::Neighbours;
    const RobotScene made = inFile(arguments.input, [&] { return sceneOf(robot, request, find); });
    saveScene(made.scene, arguments.output);
    const Json links = sayLinks(made, console);
    Json joints = Json::array();
    for (const Joint& joint : made.scene.joints) {
        Motion motion;
        motion.dofs = joint.dofs;
        for (Dof& dof : motion.dofs) dof.name = dof.kind == DofKind::Rotation ? "turns" : "slides";
        joints.push_back({{"path", joint.path}, {"dofs", joint.dofs.size()}});
        console.say(joint.path.substr(joint.path.rfind('/') + 1) + ": " +
                    (joint.dofs.empty() ? "fixed" : describeDofs(motion)));
    }
    for (const std::string& note : made.notes) console.say("note: " + note);
    remarkSizes(made.scene, console);
    Json pairs = Json::array();
    for (const Pair& pair : made.scene.pairs) pairs.push_back(pair.path);
    console.say(fmt::format("wrote {}: {}, {}, {}; next: tss bake {} -o BAKED.tss", arguments.output,
                            counted(robot.links.size(), "link"), counted(robot.joints.size(), "joint"),
                            counted(made.scene.pairs.size(), "pair"), arguments.output));
    console.print({{"output", arguments.output},
                   {"robot", robot.name},
                   {"links", links},
                   {"joints", joints},
                   {"pairs", pairs},
                   {"notes", made.notes}});
}

} // namespace tss::tool
