#include "bake/base/Error.h"
#include "bake/geometry/Import.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/RigFile.h"
#include "bake/model/AddPair.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/Command.h"
#include "bake/tool/DofSpec.h"
#include "bake/tool/FreeingAdvice.h"
#include "bake/tool/MakeScene.h"
#include "bake/tool/SceneMotion.h"

#include <filesystem>
#include <fmt/format.h>
#include <numbers>

namespace tss::tool {

namespace {

struct MakeArguments : WholeSceneArguments {
    std::string a, b, offset = "0,0,0", rest, unit = "1";
    std::vector<std::string> dofs;
    RobotFile robot;

    bool isWhole() const { return !bodies.empty() || !skins.empty(); }
};

/// said: receives what the file says of itself.
int addBody(SceneModel& scene, const std::string& file, const Vec3& color, Json& audits, MeshFileNotes& said,
            const Console& console) {
    Body body;
    body.mesh = importMesh(file, &said);
    for (const std::string& remark : remarks(file, said, scene.metersPerUnit)) console.say("note: " + remark);
    const MeshAudit audit = auditMesh(body.mesh);
    const Vec3 units = bounds(body.mesh).isEmpty() ? Vec3::Zero() : Vec3(bounds(body.mesh).sizes());
    const Vec3 size = 1000 * scene.metersPerUnit * units;
    console.say(fmt::format("{}: {}\n  {}", file, text(audit), sizeText(units, scene.metersPerUnit)));
    audits.push_back({{"file", file},
                      {"vertices", body.mesh.vertices.size()},
                      {"triangles", body.mesh.triangles.size()},
                      {"watertight", audit.watertight},
                      {"sizeMm", {size.x(), size.y(), size.z()}},
                      {"text", text(audit)}});
    body.path =
        "/" + scene.defaultPrim + "/" + freePrimName(scene, std::filesystem::path(file).stem().string());
    body.displayColor = color;
    body.rigid = true;
    scene.bodies.push_back(body);
    return static_cast<int>(scene.bodies.size()) - 1;
}

Motion parseMotion(const MakeArguments& arguments) {
    Motion motion;
    motion.dofs = parseDofs(arguments.dofs, arguments.metersPerUnit);
    motion.base.translation() = parseVector(arguments.offset, "--b-offset");
    std::vector<double> rest(motion.dofCount(), 0.0);
    if (!arguments.rest.empty()) rest = parseNumbers(arguments.rest, "--rest");
    if (rest.size() != motion.dofCount())
        throw InputError("--rest: expected one value for each of the " + std::to_string(motion.dofCount()) +
                         " DOFs");
    for (std::size_t k = 0; k < rest.size(); ++k) {
        Dof& dof = motion.dofs[k];
        const double value = fromUser(dof, rest[k]);
        if (!arguments.rest.empty() && (value < dof.lower || value > dof.upper))
            throw InputError(fmt::format("--rest: expected {:.6g} to {:.6g} for {}, found {}",
                                         toUser(dof, dof.lower), toUser(dof, dof.upper), dof.name, rest[k]));
        dof.rest = std::clamp(value, dof.lower, dof.upper);
    }
    return motion;
}

/// An axis far away from both bodies, A and B of the scene, is mostly one in another unit.
void remarkFarAxes(const Motion& motion, const SceneModel& scene, const Console& console) {
    constexpr double far = 10; // of their size
    Eigen::AlignedBox3d box;
    for (const Vec3& v : scene.bodies[0].mesh.vertices) box.extend(v);
    for (const Vec3& v : scene.bodies[1].mesh.vertices) box.extend(motion.base * v);
    for (const Dof& dof : motion.dofs) {
        if (dof.kind != DofKind::Rotation) continue;
        const Vec3 middle = box.center();
        const double away = dof.axis.cross(dof.origin - middle).norm(), size = box.diagonal().norm();
        if (away > far * size)
            console.say(fmt::format("note: the axis of {} passes the meshes at {:.3g} times their size; are "
                                    "its origin and they in the same unit?",
                                    dof.name, away / size));
    }
}

void remarkSizes(const SceneModel& scene, const Console& console) {
    const double size = largestDiagonal(scene) * scene.metersPerUnit;
    if (isOddSize(size))
        console.say(fmt::format("note: the meshes are {} long if one of their units is {} m; if they are "
                                "not, say what it is: --meters-per-unit 0.001 for millimetres",
                                lengthText(size, 1), scene.metersPerUnit));
    if (const std::string text = unlikeUnits(scene); !text.empty()) console.say("note: " + text);
}

/// Limits that small are mostly radians; others let nothing move, or go round and round.
void remarkLimits(const Motion& motion, const Console& console) {
    for (const Dof& dof : motion.dofs) {
        const double span = toUser(dof, dof.upper) - toUser(dof, dof.lower);
        if (span == 0)
            console.say(fmt::format("note: the limits of {} leave it one value: it stands still", dof.name));
        if (dof.kind == DofKind::Rotation && span > 360)
            console.say(fmt::format("note: {} turns by {:.6g} degrees in all, the same poses more than once; "
                                    "-180:180 is one whole turn",
                                    dof.name, span));
        if (dof.kind == DofKind::Rotation && span > 0 && span <= 2 * std::numbers::pi)
            console.say(fmt::format(
                "note: {} turns by {:.3g} degrees in all; limits are degrees, not radians", dof.name, span));
    }
}

/// What makes no sense beside a robot's file. Not left to the parser, which would say so before it says of a
/// misspelt option, whose value is taken for a robot's file, that there is none of that name.
constexpr const char* notForRobots[] = {"--a",    "--b",     "--dof",  "--b-offset", "--rest",
                                        "--body", "--joint", "--skin", "--bone",     "--muscle"};

/// What such a file says itself, but not the mesh formats of characters.
constexpr const char* ofMeshes[] = {"--meters-per-unit", "--up-axis"};

/// A robot's file, or two meshes and a motion: one of the two, and all of it.
void checkUsage(const MakeArguments& arguments, const CLI::App& command) {
    if (!arguments.robot.input.empty())
        for (const char* option : notForRobots)
            if (command.count(option) > 0) throw CLI::ExcludesError(option, "a robot's file");
    if (!arguments.robot.input.empty() && !isRigName(arguments.robot.input))
        for (const char* option : ofMeshes)
            if (command.count(option) > 0) throw CLI::ExcludesError(option, "a robot's file");
    if (!arguments.robot.input.empty() || arguments.isWhole()) return;
    if (arguments.a.empty()) throw CLI::RequiredError("--a, or --body, or a robot's file");
    if (arguments.b.empty()) throw CLI::RequiredError("--b");
    if (arguments.dofs.empty()) throw CLI::RequiredError("--dof");
}

/// --a, --b and --dof: a scene of two bodies and their joint.
void makePair(const MakeArguments& arguments, const Console& console) {
    SceneModel scene;
    scene.metersPerUnit = arguments.metersPerUnit;
    scene.defaultPrim = freePrimName(scene, std::filesystem::path(arguments.output).stem().string());
    Json audits = Json::array();
    const Motion motion = parseMotion(arguments);
    MeshFileNotes saidOfA, saidOfB;
    const int a = addBody(scene, arguments.a, {0.82, 0.77, 0.66}, audits, saidOfA, console);
    const int b = addBody(scene, arguments.b, {0.74, 0.64, 0.48}, audits, saidOfB, console);
    const int pair = addPair(scene, a, b, motion, "Joint");
    const bool bothY = saidOfA.upAxis == 'Y' && saidOfB.upAxis == 'Y';
    scene.upAxis = !arguments.upAxis.empty() ? arguments.upAxis[0] : bothY ? 'Y' : 'Z';
    if (arguments.motion.empty())
        addShowMotion(scene);
    else
        applyMotion(scene, arguments.motion);
    saveScene(scene, arguments.output);
    console.say("joint  " + describeDofs(motion, scene.metersPerUnit));
    remarkSizes(scene, console);
    if (saidOfA.upAxis != '\0' && saidOfB.upAxis != '\0' && saidOfA.upAxis != saidOfB.upAxis)
        console.say(fmt::format("note: {} says that {} is up, and {} that {} is; nothing is turned: write "
                                "one of them as the other",
                                arguments.a, saidOfA.upAxis, arguments.b, saidOfB.upAxis));
    remarkLimits(motion, console);
    remarkFarAxes(motion, scene, console);
    console.say("wrote " + arguments.output + "; next: tss bake " + shellWord(arguments.output) +
                " -o BAKED.tss");
    console.print({{"output", arguments.output},
                   {"pair", scene.pairs[pair].path},
                   {"meshes", audits},
                   {"freeingMoves", adviseMoves(scene, scene.pairs[pair], 1, console)}});
}

void make(MakeArguments& arguments, const CLI::App& command, const Console& console) {
    checkUsage(arguments, command);
    expectScene(arguments.output);
    if (command.count("--meters-per-unit") > 0 || arguments.robot.input.empty())
        arguments.metersPerUnit = parseUnit(arguments.unit, "--meters-per-unit");
    if (!arguments.robot.input.empty()) {
        if (command.count("--meters-per-unit") > 0) arguments.robot.metersPerUnit = arguments.metersPerUnit;
        if (!arguments.upAxis.empty()) arguments.robot.upAxis = arguments.upAxis[0];
        if (isRigName(arguments.robot.input) && isRigName(arguments.motion))
            std::swap(arguments.robot.animation, arguments.motion);
        if (!arguments.motion.empty() && arguments.robot.pairs == "near")
            arguments.robot.pairs = "all"; // what comes near in the file's own animation says nothing of it
        return makeRobot(arguments.robot, arguments.motion, arguments.output, console);
    }
    arguments.pairs = arguments.robot.pairs;
    arguments.offsets = arguments.robot.offsets;
    arguments.isWhole() ? makeWholeScene(arguments, console) : makePair(arguments, console);
}

void addRobotOptions(CLI::App& command, const std::shared_ptr<MakeArguments>& arguments) {
    RobotFile& robot = arguments->robot;
    CLI::Option* input = command.add_option(
        "robot", robot.input,
        "a robot's file, in place of --a, --b and --dof: URDF, MJCF of MuJoCo, .usda with UsdPhysics or "
        "UsdSkel, or a rigged character as .glb, .gltf, .fbx, .dae and others");
    for (CLI::Option* option : addRobotFileOptions(command, robot)) option->needs(input);
    command
        .add_option(
            "--geometry", robot.geometry,
            "collision or visual: the shapes that a link is made of; the others where it has none of these")
        ->check(CLI::IsMember({"collision", "visual"}))
        ->needs(input)
        ->capture_default_str();
    command
        .add_option("--pairs", robot.pairs,
                    "neighbours: of each joint; all: of all links that move against each other; near: these, "
                    "but of a character's bones only those that its animation has near each other")
        ->check(CLI::IsMember({"neighbours", "all", "near"}))
        ->excludes(command.get_option("--a"))
        ->capture_default_str();
    command
        .add_option("--offset", robot.offsets,
                    "LINK=X,Y,Z: moves a link or --body, with what hangs on it, at its joint by that, in its "
                    "own frame; repeat, they add up")
        ->allow_extra_args(false)
        ->excludes(command.get_option("--a"));
}

void addWholeSceneOptions(CLI::App& command, const std::shared_ptr<MakeArguments>& arguments) {
    WholeSceneArguments& whole = *arguments;
    const auto add = [&](const char* name, std::vector<std::string>& texts, const char* description) {
        CLI::Option* option = command.add_option(name, texts, description)->allow_extra_args(false);
        for (const char* other : {"--a", "--b", "--dof", "--b-offset", "--rest"})
            option->excludes(command.get_option(other));
        return option;
    };
    add("--body", whole.bodies,
        "[NAME=]MESH: a rigid body; repeat. All meshes lie as they do where every joint is at 0");
    add("--joint", whole.joints,
        "NAME=PARENT,CHILD:DOF[;DOF...][;offset:X,Y,Z]: a joint of two bodies, its DOFs as for --dof; the "
        "child, with what hangs on it, is moved by the offset first; repeat");
    CLI::Option* skin = add("--skin", whole.skins, "[NAME=]MESH: a skin over the bodies and muscles");
    add("--bone", whole.bones, "BODY: a body that the skin lies on; repeat (default: all)")->needs(skin);
    add("--muscle", whole.muscles,
        "[NAME=]MESH[,from=BODY,to=BODY,contract=0.15,sheet|ring]: a muscle; its fibre line is found from "
        "its mesh, the end at its `from` body stays, which it moves with; repeat");
}

} // namespace

void addMake(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(
        app, console, "make", "a scene from two meshes and the motion between them, or from a robot's file");
    auto arguments = std::make_shared<MakeArguments>();
    command->add_option("-o,--output", arguments->output, "the scene to write")->required();
    command->add_option("--a", arguments->a, "mesh of the body that stays, any format that assimp reads");
    command->add_option("--b", arguments->b, "mesh of the body that moves");
    command
        ->add_option("--meters-per-unit", arguments->unit,
                     "length of the meshes' unit in metres, or with a unit of its own: 0.001 or 1mm")
        ->capture_default_str();
    command
        ->add_option(
            "--dof", arguments->dofs,
            "rot:ORIGIN:AXIS:LO:HI, trans:AXIS:LO:HI or path:FILE.csv:LO:HI; repeat: x' = D1 D2 ... x")
        ->expected(1, -1);
    command->add_option("--b-offset", arguments->offset, "x,y,z added to the points of B first");
    command->add_option("--rest", arguments->rest,
                        "DOF values at which the joint rests: where a motion starts, and meshes that overlap "
                        "are free (default 0, or the limit next to it). The meshes lie as they do at 0");
    command->add_option(
        "--motion", arguments->motion,
        "a CSV file, the motion that the scene plays: a line of names (time or step, joints, "
        "muscles), then degrees, units of a value, or activations. Else each moves in turn. Of a "
        "character of a mesh format also another such file, whose animations it takes");
    command
        ->add_option("--up-axis", arguments->upAxis,
                     "Y or Z (default Z; Y where the files of --a and --b say so, or all are glTF)")
        ->check(CLI::IsMember({"Y", "Z"}));
    addRobotOptions(*command, arguments);
    addWholeSceneOptions(*command, arguments);
    command->footer("Example, a hinge of 30 degrees about the Y axis through 0.3,0,0.7:\n"
                    "  tss make -o jaw.tss --a skull.obj --b mandible.obj --dof rot:0.3,0,0.7:0,1,0:-24:6\n"
                    "The limits are degrees; for meshes in millimetres add --meters-per-unit 0.001.\n"
                    "A robot:\n  tss make robot.urdf -o robot.tss --package my_robot=../my_robot\n" +
                    app.get_footer());
    command->callback([arguments, command, &console] { make(*arguments, *command, console); });
}

} // namespace tss::tool
