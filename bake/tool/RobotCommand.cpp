#include "bake/tool/MakeScene.h"

#include "bake/base/Error.h"
#include "bake/base/Words.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/model/Kinematics.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/pipeline/FirstLook.h"
#include "bake/robot/RobotScene.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/DofSpec.h"
#include "bake/tool/SceneMotion.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>

namespace tss::tool {

namespace {

/// Robots have many frames and fixed joints, of which there is nothing to say.
void sayTogether(const char* what, const std::vector<std::string>& names, const Console& console) {
    constexpr std::size_t most = 6;
    if (!names.empty()) console.say(fmt::format("{}: {}", what, firstOf(names, most)));
}

Json sayLinks(const RobotScene& made, const Console& console) {
    Json links = Json::array();
    std::vector<std::string> frames;
    for (const LinkReport& link : made.links) {
        const Body& body = made.scene.bodies[findBody(made.scene, link.body)];
        const std::string name = primName(body.path);
        Json json = {{"body", body.path}, {"shapes", link.shapes}, {"triangles", body.mesh.triangles.size()}};
        if (body.mesh.empty()) {
            frames.push_back(name);
        } else {
            const Vec3 size = bounds(body.mesh).sizes();
            const MeshAudit audit = auditMesh(body.mesh);
            console.say(fmt::format("{}: {}{}\n  {}", name, text(audit),
                                    link.shapes > 1 ? fmt::format(" ({} shapes as one)", link.shapes) : "",
                                    sizeText(size, made.scene.metersPerUnit)));
            json["watertight"] = audit.watertight;
            const double mm = 1000 * made.scene.metersPerUnit;
            json["sizeMm"] = {mm * size.x(), mm * size.y(), mm * size.z()};
        }
        links.push_back(json);
    }
    sayTogether("no geometry", frames, console);
    return links;
}

void remarkBodySizes(const SceneModel& scene, const Console& console) {
    std::vector<std::string> odd;
    for (const Body& body : scene.bodies) {
        const double size = body.mesh.empty() ? 0 : diagonal(body.mesh) * scene.metersPerUnit;
        if (isOddSize(size)) odd.push_back(fmt::format("{} {}", body.path, lengthText(size, 1)));
    }
    constexpr std::size_t most = 4;
    if (!odd.empty())
        console.say(fmt::format("note: how long bodies are if one unit of their meshes is {} m: {}; where "
                                "that is wrong, say what it is: metersPerUnit of a stage, a scale in another "
                                "robot's file, else --meters-per-unit",
                                scene.metersPerUnit, firstOf(odd, most)));
}

/// The command to go on with: where there are many pairs, in about as much time as somebody waits.
std::string nextCommand(const SceneModel& scene, const std::string& output) {
    const bool many = scene.pairs.size() > 40 || std::ranges::any_of(scene.pairs, [&](const Pair& pair) {
                          return isLongChain(scene, pair);
                      });
    return "tss bake " + shellWord(output) + " -o BAKED.tss" + (many ? " --budget 120" : "");
}

/// The tolerances that the pairs have of their own. Nothing: none.
std::string ownTolerances(const SceneModel& scene) {
    std::map<double, std::string> tolerances;
    for (const Pair& pair : scene.pairs)
        if (const auto at = pair.settings.find("tolerance"); at != pair.settings.end())
            tolerances.emplace(parseLength(at->second, scene.metersPerUnit), at->second);
    if (tolerances.empty()) return "";
    const std::string &least = tolerances.begin()->second, &most = tolerances.rbegin()->second;
    return fmt::format("tolerances: {}, each pair its own (tss:bake:tolerance in the scene; bake --tolerance "
                       "sets one for all)",
                       least == most ? least : least + " to " + most);
}

/// What makes fewer pairs, where there are so many that they take longer than somebody waits.
std::string fewerPairs(const SceneModel& scene) {
    constexpr std::size_t many = 100;
    const auto tied = [&](const Pair& pair) { return tiesDirectly(scene, pair); };
    if (scene.pairs.size() <= many || std::ranges::all_of(scene.pairs, tied) ||
        std::ranges::none_of(scene.pairs, tied))
        return "";
    return fmt::format("{} take some seconds of one core each; for a picture sooner make only those that a "
                       "joint ties: --pairs neighbours",
                       counted(scene.pairs.size(), "pair"));
}

/// Parts that no joint ties and that overlap all the same mostly lie where they should not. Nothing: none.
std::string overlapsElsewhere(const SceneModel& scene, const std::vector<double>& distances) {
    std::vector<std::string> both;
    for (std::size_t k = 0; k < scene.pairs.size(); ++k)
        if (const Pair& pair = scene.pairs[k]; distances[k] == 0 && !tiesDirectly(scene, pair))
            both.push_back(fmt::format("{} and {}", primName(scene.bodies[pair.bodyA].path),
                                       primName(scene.bodies[pair.bodyB].path)));
    if (both.empty()) return "";
    return fmt::format("{}: touch or overlap where the joints rest, though no joint ties them; what overlaps "
                       "there is excepted. Where it should not, look at where they lie, and at tss:rest",
                       fmt::join(both, ", "));
}

} // namespace

std::string sizeText(const Vec3& size, double metersPerUnit) {
    const auto length = [&](int axis) { return lengthText(size[axis], metersPerUnit); };
    return fmt::format("{} x {} x {}", length(0), length(1), length(2));
}

bool isOddSize(double metres) {
    constexpr double house = 10, grain = 1e-3;
    return metres > house || (metres > 0 && metres < grain);
}

Json sayScene(const MadeScene& made, const std::string& output, const Console& console) {
    const Json links = sayLinks(made, console);
    Json joints = Json::array();
    std::vector<std::string> fixed;
    for (const Joint& joint : made.scene.joints) {
        Motion motion;
        motion.dofs = joint.dofs;
        for (Dof& dof : motion.dofs)
            dof.name = dof.kind == DofKind::Rotation      ? "turns"
                       : dof.kind == DofKind::Translation ? "slides"
                                                          : "goes along its path";
        joints.push_back({{"path", joint.path}, {"dofs", joint.dofs.size()}});
        if (joint.dofs.empty())
            fixed.push_back(primName(joint.path));
        else
            console.say(primName(joint.path) + ": " + describeDofs(motion, made.scene.metersPerUnit));
    }
    sayTogether("fixed", fixed, console);
    std::vector<std::string> notes = made.notes;
    if (std::string note = overlapsElsewhere(made.scene, made.distances); !note.empty())
        notes.push_back(std::move(note));
    for (const std::string& note : notes) console.say("note: " + note);
    remarkBodySizes(made.scene, console);
    for (const std::string& text : {ownTolerances(made.scene), fewerPairs(made.scene)})
        if (!text.empty()) console.say(text);
    Json pairs = Json::array(), muscles = Json::array(), skins = Json::array();
    for (const Pair& pair : made.scene.pairs) pairs.push_back(pair.path);
    for (const MuscleModel& muscle : made.scene.muscles) muscles.push_back(muscle.path);
    for (const SkinModel& skin : made.scene.skins) skins.push_back(skin.path);
    const bool nothing = pairs.empty() && skins.empty();
    console.say(fmt::format("wrote {}: {}, {}, {}; {}", output, counted(made.links.size(), "part"),
                            counted(made.scene.joints.size(), "joint"), counted(pairs.size(), "pair"),
                            nothing ? "nothing to bake: no two bodies with a surface move against each other"
                                    : "next: " + nextCommand(made.scene, output)));
    return {{"output", output}, {"robot", made.scene.defaultPrim},
            {"links", links},   {"joints", joints},
            {"pairs", pairs},   {"muscles", muscles},
            {"skins", skins},   {"notes", notes}};
}

void makeRobot(const RobotFile& from, const std::string& motion, const std::string& output,
               const Console& console) {
    MadeScene made = readRobotScene(from);
    if (!motion.empty()) {
        if (made.scene.layer)
            throw InputError(
                Where{from.input},
                "is a scene of osgTSS already, which has its motion in it; --motion is for one to make");
        applyMotion(made.scene, motion);
    }
    saveScene(made.scene, output);
    console.print(sayScene(made, output, console));
}

} // namespace tss::tool
