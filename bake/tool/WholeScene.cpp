#include "bake/tool/WholeScene.h"

#include "bake/base/Error.h"
#include "bake/geometry/FibreLine.h"
#include "bake/geometry/Import.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/model/AddPair.h"
#include "bake/model/Kinematics.h"
#include "bake/model/ShowMotion.h"
#include "bake/motion/MuscleFibre.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/robot/RobotScene.h"
#include "bake/scene/Layer.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/DofSpec.h"
#include "bake/tool/FreeingAdvice.h"
#include "bake/tool/RobotCommand.h"
#include "bake/tool/SceneMotion.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <limits>

namespace tss::tool {

namespace {

/// "NAME=MESH", or MESH that gives its name.
struct Named {
    std::string name, file;
};

Named namedMesh(const std::string& text) {
    const auto sign = text.find('=');
    const bool named = sign != text.npos && isPrimName(text.substr(0, sign));
    Named result{named ? text.substr(0, sign) : "", named ? text.substr(sign + 1) : text};
    if (!named) result.name = std::filesystem::path(result.file).stem().string();
    return result;
}

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
        const Named named = namedMesh(text);
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

class SoftParts {
public:
    SoftParts(RobotScene& made, const Robot& robot, const Console& console)
        : made_(made), scene_(made.scene), robot_(robot), console_(console) {}

    /// [NAME=]MESH[,from=BODY,to=BODY,contract=0.15,sheet|ring]
    void addMuscle(const std::string& text) {
        const std::string option = "--muscle " + text;
        const std::vector<std::string> parts = split(text, ',');
        MuscleModel model;
        for (std::size_t k = 1; k < parts.size(); ++k) {
            const auto sign = parts[k].find('=');
            const std::string key = parts[k].substr(0, sign),
                              value = sign == text.npos ? "" : parts[k].substr(sign + 1);
            if (parts[k] == "sheet")
                model.muscle.form = MuscleForm::Sheet;
            else if (parts[k] == "ring")
                model.muscle.form = MuscleForm::Ring;
            else if (key == "from" || key == "to")
                (key == "from" ? model.bone : model.insertionBone) = linkCalled(robot_, value, option);
            else if (key == "contract")
                model.muscle.maxContraction = parseNumber(value, option);
            else
                throw InputError(option +
                                 ": expected from=BODY, to=BODY, contract=0.15, sheet or ring, found \"" +
                                 parts[k] + "\"");
        }
        if (!(model.muscle.maxContraction > 0 && model.muscle.maxContraction < 1))
            throw InputError(option + ": contract: expected a share of its length between 0 and 1");
        const Named named = namedMesh(parts[0]);
        const Pose placement = model.bone < 0 ? Pose::Identity() : scene_.bodies[model.bone].placement;
        model.path = pathOf(named.name);
        const int body = addBody(named, named.name + "Surface", placement, {0.62, 0.20, 0.18});
        model.body = body;
        const TriangleMesh& mesh = scene_.bodies[body].mesh;
        const double open = openShare(mesh);
        if (open > mostOpenShare)
            note(fmt::format(
                "{} is not closed, its openings are {:.0f} % as large as it, and bake will refuse "
                "it: a muscle's volume is to be kept",
                named.name, 100 * open));
        else if (!enclosesVolume(mesh))
            note(named.name + " is flat or inside out, and bake will refuse it: expected a muscle with a "
                              "volume");
        else if (open > 0)
            note(fmt::format("{} is not closed: its openings, {:.2g} % as large as it, count as closed by "
                             "flat fans",
                             named.name, 100 * open));
        model.muscle.surface = mesh;
        if (model.insertionBone == model.bone) model.insertionBone = -1;
        model.muscle.spans = model.insertionBone >= 0;
        if (model.muscle.form == MuscleForm::Ring) {
            model.muscle.fibre = ringLine(mesh);
        } else {
            model.muscle.fibre = fibreLine(mesh);
            orient(model, placement);
            if (!goesOnAlongChord(model.muscle.fibre))
                note(named.name + " winds round so far that its line comes back along the way from end to "
                                  "end: it will not shorten along all of it; cut it into two muscles");
        }
        scene_.muscles.push_back(model);
        sayMuscle(named.name, model);
        remarkMuscle(named.name, model);
    }

    void addSkin(const std::string& text, const std::vector<std::string>& bones) {
        const Named named = namedMesh(text);
        SkinModel skin;
        skin.body = addBody(named, named.name, Pose::Identity(), {0.87, 0.68, 0.58});
        skin.path = scene_.bodies[skin.body].path;
        for (std::size_t m = 0; m < scene_.muscles.size(); ++m) skin.muscles.push_back(static_cast<int>(m));
        if (bones.empty())
            for (std::size_t k = 0; k < robot_.links.size(); ++k) skin.bones.push_back(static_cast<int>(k));
        for (const std::string& bone : bones) skin.bones.push_back(linkCalled(robot_, bone, "--bone"));
        remarkSkin(named.name, skin);
        scene_.skins.push_back(skin);
    }

    /// Meshes that differ by a thousand in size are mostly in different units.
    void remarkUnits() {
        if (const std::string text = unlikeUnits(scene_); !text.empty()) note(text);
    }

private:
    std::string pathOf(const std::string& name) const {
        return "/" + scene_.defaultPrim + "/" + freePrimName(scene_, name);
    }

    void note(const std::string& text) { made_.notes.push_back(text); }

    int addBody(const Named& named, const std::string& name, const Pose& placement, const Vec3& color) {
        Body body;
        MeshFileNotes said;
        body.mesh = importMesh(named.file, &said);
        for (const std::string& remark : remarks(named.file, said, scene_.metersPerUnit)) note(remark);
        body.path = pathOf(name);
        body.placement = placement;
        body.displayColor = color;
        scene_.bodies.push_back(body);
        made_.links.push_back({body.path, 1, false});
        return static_cast<int>(scene_.bodies.size()) - 1;
    }

    /// How much nearer a muscle's points lie to the bone of its insertion than to that of its origin.
    std::vector<double> towardsInsertion(const MuscleModel& model, const Pose& placement) const {
        std::vector<double> nearer(model.muscle.fibre.size(), 0);
        for (const auto& [bone, side] : {std::pair(model.bone, 1.0), std::pair(model.insertionBone, -1.0)}) {
            if (bone < 0 || scene_.bodies[bone].mesh.empty()) continue;
            const Pose toBone = scene_.bodies[bone].placement.inverse(Eigen::Isometry) * placement;
            const MeshQuery query(scene_.bodies[bone].mesh);
            for (std::size_t k = 0; k < nearer.size(); ++k)
                nearer[k] += side * query.distance(toBone * model.muscle.fibre[k]);
        }
        return nearer;
    }

    /// The end that stays comes first: the one nearer to its bone, or the one farther from where it goes to.
    void orient(MuscleModel& model, const Pose& placement) const {
        const std::vector<double> nearer = towardsInsertion(model, placement);
        if (nearer.front() > nearer.back()) std::ranges::reverse(model.muscle.fibre);
    }

    void sayMuscle(const std::string& name, const MuscleModel& model) const {
        const auto point = [](const Vec3& p) {
            return fmt::format("{:.4g},{:.4g},{:.4g}", p.x(), p.y(), p.z());
        };
        const auto onBone = [&](int bone) {
            return bone >= 0 ? " (on " + robot_.links[bone].name + ")" : "";
        };
        const std::vector<Vec3>& fibre = model.muscle.fibre;
        if (model.muscle.form == MuscleForm::Ring)
            return console_.say(fmt::format("{}: a ring of {} points from {} round, narrows by {:.3g}", name,
                                            fibre.size(), point(fibre.front()), model.muscle.maxContraction));
        console_.say(fmt::format("{}: a {} of {} points from {}{} to {}{}, shortens by {:.3g} of its length",
                                 name, model.muscle.form == MuscleForm::Sheet ? "sheet" : "tube",
                                 fibre.size(), point(fibre.front()), onBone(model.bone), point(fibre.back()),
                                 onBone(model.insertionBone), model.muscle.maxContraction));
    }

    /// A muscle moves with its bones; skin on another one is pushed by what of the muscle lies there.
    void remarkMuscle(const std::string& name, const MuscleModel& model) {
        constexpr double most = 0.25; // of its vertices
        if (model.bone < 0) return;
        const Body& surface = scene_.bodies[model.body];
        const std::vector<Vec3>& vertices = surface.mesh.vertices;
        std::vector<double> nearest(vertices.size(), std::numeric_limits<double>::infinity());
        std::vector<int> whose(vertices.size(), model.bone);
        for (int k = 0; k < static_cast<int>(robot_.links.size()); ++k) {
            const Body& bone = scene_.bodies[k];
            if (bone.mesh.empty()) continue;
            const MeshQuery query(bone.mesh);
            const Pose toBone = bone.placement.inverse(Eigen::Isometry) * surface.placement;
            for (std::size_t v = 0; v < vertices.size(); ++v)
                if (const double distance = query.distance(toBone * vertices[v]); distance < nearest[v])
                    nearest[v] = distance, whose[v] = k;
        }
        const std::vector<int> roots = rigidRoots(scene_);
        for (int k = 0; k < static_cast<int>(robot_.links.size()); ++k) {
            const auto count = static_cast<double>(std::ranges::count(whose, k));
            if (roots[k] != roots[model.bone] && k != model.insertionBone &&
                count > most * static_cast<double>(vertices.size()))
                note(
                    fmt::format("{:.0f} % of the muscle {} lie nearer to {} than to {}, which it moves with: "
                                "where the two move against each other it pushes the skin of the other",
                                100 * count / static_cast<double>(vertices.size()), name,
                                robot_.links[k].name, robot_.links[model.bone].name));
        }
    }

    void remarkSkin(const std::string& name, const SkinModel& skin) {
        constexpr double far = 0.2; // of the skin's size
        const TriangleMesh& mesh = scene_.bodies[skin.body].mesh;
        const MeshQuery query(mesh);
        const double size = diagonal(mesh);
        if (skin.bones.empty() && skin.muscles.empty())
            note(fmt::format("the skin {} lies on nothing and stays as it is: expected bodies as --body, or "
                             "muscles as --muscle",
                             name));
        for (int bone : skin.bones) {
            const Body& body = scene_.bodies[bone];
            if (body.mesh.empty()) continue;
            const double away = query.distanceTo(MeshQuery(body.mesh), body.placement);
            if (away > far * size)
                note(fmt::format(
                    "the skin {} is nowhere near {}, {} away; do they lie in one place, in one unit?", name,
                    body.path, lengthText(away, scene_.metersPerUnit)));
        }
        for (int muscle : skin.muscles) {
            const Body& body = scene_.bodies[scene_.muscles[muscle].body];
            std::size_t inside = 0;
            for (const Vec3& v : body.mesh.vertices) inside += query.inside(body.placement * v);
            if (2 * inside < body.mesh.vertices.size())
                note(fmt::format(
                    "most of the muscle {} lies outside of the skin {}: it will not push it from below",
                    scene_.muscles[muscle].path, name));
        }
    }

    RobotScene& made_;
    SceneModel& scene_;
    const Robot& robot_;
    const Console& console_;
};

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
    request.pairs = arguments.pairs == "all" ? RobotPairs::All : RobotPairs::Neighbours;
    RobotScene made = sceneOf(robot, request, [](const std::string& name) { return name; });
    SoftParts soft(made, robot, console);
    for (const std::string& muscle : arguments.muscles) soft.addMuscle(muscle);
    for (const std::string& skin : arguments.skins) soft.addSkin(skin, arguments.bones);
    soft.remarkUnits();
    if (arguments.motion.empty())
        addShowMotion(made.scene);
    else
        applyMotion(made.scene, arguments.motion);
    saveScene(made.scene, arguments.output);
    Json result = sayScene(made, arguments.output, console);
    for (const Pair& pair : made.scene.pairs)
        if (tiesDirectly(made.scene, pair))
            for (Json& move : adviseMoves(made.scene, pair, console)) {
                move["pair"] = pair.path;
                result["freeingMoves"].push_back(std::move(move));
            }
    console.print(result);
}

} // namespace tss::tool
