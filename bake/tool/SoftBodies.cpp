#include "bake/base/Error.h"
#include "bake/geometry/FibreLine.h"
#include "bake/geometry/Import.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/model/AddPair.h"
#include "bake/model/Kinematics.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MuscleFibre.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/scene/Layer.h"
#include "bake/tool/DofSpec.h"
#include "bake/tool/MakeScene.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <limits>

namespace tss::tool {

namespace {

/// The muscle that the parts of a --muscle behind its mesh describe: its bones, form and contraction.
MuscleModel parseMuscle(const std::vector<std::string>& parts, const Robot& robot,
                        const std::string& option) {
    MuscleModel model;
    for (std::size_t k = 1; k < parts.size(); ++k) {
        const auto sign = parts[k].find('=');
        const std::string key = parts[k].substr(0, sign),
                          value = sign == std::string::npos ? "" : parts[k].substr(sign + 1);
        if (parts[k] == "sheet")
            model.muscle.form = MuscleForm::Sheet;
        else if (parts[k] == "ring")
            model.muscle.form = MuscleForm::Ring;
        else if (key == "from")
            model.bone = linkCalled(robot, value, option);
        else if (key == "to")
            model.insertionBone = linkCalled(robot, value, option);
        else if (key == "contract")
            model.muscle.maxContraction = parseNumber(value, option);
        else
            throw InputError(option +
                             ": expected from=BODY, to=BODY, contract=0.15, sheet or ring, found \"" +
                             parts[k] + "\"");
    }
    if (!(model.muscle.maxContraction > 0 && model.muscle.maxContraction < 1))
        throw InputError(option + ": contract: expected a share of its length between 0 and 1");
    if (model.insertionBone == model.bone) model.insertionBone = -1;
    model.muscle.spans = model.insertionBone >= 0;
    return model;
}

class SoftBodies {
public:
    SoftBodies(RobotScene& made, const Robot& robot, const Console& console)
        : made_(made), scene_(made.scene), robot_(robot), console_(console) {}

    void addMuscle(const std::string& text) {
        const std::vector<std::string> parts = split(text, ',');
        MuscleModel model = parseMuscle(parts, robot_, "--muscle " + text);
        const NamedMesh named = namedMesh(parts[0]);
        const Pose placement = model.bone < 0 ? Pose::Identity() : scene_.bodies[model.bone].placement;
        model.path = pathOf(named.name);
        model.body = addBody(named, named.name + "Surface", placement, {0.62, 0.20, 0.18});
        model.muscle.surface = scene_.bodies[model.body].mesh;
        remarkVolume(named.name, model.muscle.surface);
        setFibre(named.name, model, placement);
        scene_.muscles.push_back(model);
        say(named.name, model);
        remarkOtherBones(named.name, model);
    }

    void addSkin(const std::string& text, const std::vector<std::string>& bones) {
        const NamedMesh named = namedMesh(text);
        SkinModel skin;
        skin.body = addBody(named, named.name, Pose::Identity(), {0.87, 0.68, 0.58});
        skin.path = scene_.bodies[skin.body].path;
        for (std::size_t m = 0; m < scene_.muscles.size(); ++m) skin.muscles.push_back(static_cast<int>(m));
        if (bones.empty())
            for (std::size_t k = 0; k < robot_.links.size(); ++k) skin.bones.push_back(static_cast<int>(k));
        for (const std::string& bone : bones) skin.bones.push_back(linkCalled(robot_, bone, "--bone"));
        remark(named.name, skin);
        scene_.skins.push_back(skin);
    }

private:
    std::string pathOf(const std::string& name) const {
        return "/" + scene_.defaultPrim + "/" + freePrimName(scene_, name);
    }
    void note(const std::string& text) { made_.notes.push_back(text); }

    /// Returns the body's index.
    int addBody(const NamedMesh& mesh, const std::string& name, const Pose& placement, const Vec3& color) {
        Body body;
        MeshFileNotes said;
        body.mesh = importMesh(mesh.file, &said);
        for (const std::string& remark : remarks(mesh.file, said, scene_.metersPerUnit)) note(remark);
        body.path = pathOf(name);
        body.placement = placement;
        body.displayColor = color;
        scene_.bodies.push_back(body);
        made_.links.push_back({body.path, 1, false});
        return static_cast<int>(scene_.bodies.size()) - 1;
    }

    /// Finds the line that the muscle shortens along. Its end that stays comes first: the one nearer to its
    /// bone, or the one farther from the bone that it goes to.
    void setFibre(const std::string& name, MuscleModel& model, const Pose& placement) {
        std::vector<Vec3>& fibre = model.muscle.fibre;
        if (model.muscle.form == MuscleForm::Ring) {
            fibre = ringLine(model.muscle.surface);
            return;
        }
        fibre = fibreLine(model.muscle.surface);
        const std::vector<double> nearer = towardsInsertion(model, placement);
        if (nearer.front() > nearer.back()) std::ranges::reverse(fibre);
        if (!goesOnAlongChord(fibre))
            note(name +
                 " winds round so far that its line comes back along the way from end to end: it will not "
                 "shorten along all of it; cut it into two muscles");
    }

    /// How much nearer each point of the fibre lies to the bone of the insertion than to that of the origin;
    /// of a bone that there is not, nothing is counted.
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

    void say(const std::string& name, const MuscleModel& model) const {
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
        console_.say(fmt::format("{}: a {} of {} points from {}{} to {}{}{}, shortens by {:.3g} of its "
                                 "length",
                                 name, model.muscle.form == MuscleForm::Sheet ? "sheet" : "tube",
                                 fibre.size(), point(fibre.front()), onBone(model.bone), point(fibre.back()),
                                 onBone(model.insertionBone), past(model), model.muscle.maxContraction));
    }

    /// The bones that a muscle passes between its own two.
    std::string past(const MuscleModel& model) const {
        std::vector<std::string> names;
        for (const int bone : muscleChain(scene_, model))
            if (bone != model.insertionBone) names.push_back(robot_.links[bone].name);
        return names.empty() ? "" : fmt::format(" past {}", fmt::join(names, ", "));
    }

    /// A muscle keeps its volume, and so needs one.
    void remarkVolume(const std::string& name, const TriangleMesh& mesh) {
        const double open = openShare(mesh);
        if (open > mostOpenShare)
            note(fmt::format(
                "{} is not closed, its openings are {:.0f} % as large as it, and bake will refuse "
                "it: a muscle's volume is to be kept",
                name, 100 * open));
        else if (!enclosesVolume(mesh))
            note(name + " is flat or inside out, and bake will refuse it: expected a muscle with a volume");
        else if (open > 0)
            note(fmt::format(
                "{} is not closed: its openings, {:.2g} % as large as it, count as closed by flat "
                "fans",
                name, 100 * open));
    }

    /// A muscle moves with its bones; skin on another one is pushed by what of the muscle lies there.
    void remarkOtherBones(const std::string& name, const MuscleModel& model) {
        constexpr double most = 25; // per cent of its vertices
        if (model.bone < 0) return;
        const Body& surface = scene_.bodies[model.body];
        const std::vector<Vec3>& vertices = surface.mesh.vertices;
        std::vector<double> nearest(vertices.size(), std::numeric_limits<double>::infinity());
        std::vector<int> nearestBone(vertices.size(), model.bone);
        for (int k = 0; k < static_cast<int>(robot_.links.size()); ++k) {
            const Body& bone = scene_.bodies[k];
            if (bone.mesh.empty()) continue;
            const MeshQuery query(bone.mesh);
            const Pose toBone = bone.placement.inverse(Eigen::Isometry) * surface.placement;
            for (std::size_t v = 0; v < vertices.size(); ++v)
                if (const double distance = query.distance(toBone * vertices[v]); distance < nearest[v])
                    nearest[v] = distance, nearestBone[v] = k;
        }
        const std::vector<int> roots = rigidRoots(scene_), chain = muscleChain(scene_, model);
        for (int k = 0; k < static_cast<int>(robot_.links.size()); ++k) {
            const double percent = 100 * static_cast<double>(std::ranges::count(nearestBone, k)) /
                                   static_cast<double>(vertices.size());
            const bool own = roots[k] == roots[model.bone] ||
                             std::ranges::any_of(chain, [&](int c) { return roots[k] == roots[c]; });
            if (own || !(percent > most)) continue;
            const std::string &bone = robot_.links[k].name, &from = robot_.links[model.bone].name;
            if (model.insertionBone < 0)
                note(
                    fmt::format("{:.0f} % of the muscle {} lie nearer to {} than to {}, which it moves with: "
                                "where the two move against each other it pushes the skin of the other",
                                percent, name, bone, from));
            else
                note(fmt::format(
                    "{:.0f} % of the muscle {} lie nearer to {} than to {} or {}, whose motions it "
                    "mixes: where a joint bends it leaves {}; it stays beside it with from={} or "
                    "to={}",
                    percent, name, bone, from, robot_.links[model.insertionBone].name, bone, bone, bone));
        }
    }

    void remark(const std::string& name, const SkinModel& skin) {
        constexpr double far = 0.2; // of the skin's size
        const TriangleMesh& mesh = scene_.bodies[skin.body].mesh;
        const MeshQuery query(mesh);
        if (skin.bones.empty() && skin.muscles.empty())
            note(fmt::format("the skin {} lies on nothing and stays as it is: expected bodies as --body, or "
                             "muscles as --muscle",
                             name));
        for (int bone : skin.bones) {
            const Body& body = scene_.bodies[bone];
            if (body.mesh.empty()) continue;
            const double away = query.distanceTo(MeshQuery(body.mesh), body.placement);
            if (away > far * diagonal(mesh))
                note(fmt::format(
                    "the skin {} is nowhere near {}, {} away; do they lie in one place, in one unit?", name,
                    body.path, lengthText(away, scene_.metersPerUnit)));
        }
        for (int muscle : skin.muscles) {
            const Body& body = scene_.bodies[scene_.muscles[muscle].body];
            const auto inside = std::ranges::count_if(
                body.mesh.vertices, [&](const Vec3& v) { return query.inside(body.placement * v); });
            if (2 * static_cast<std::size_t>(inside) < body.mesh.vertices.size())
                note(
                    fmt::format("most of the muscle {} lies outside of the skin {}: it will not push it from "
                                "below",
                                scene_.muscles[muscle].path, name));
        }
    }

    RobotScene& made_;
    SceneModel& scene_;
    const Robot& robot_;
    const Console& console_;
};

} // namespace

void addSoftBodies(RobotScene& made, const Robot& robot, const WholeSceneArguments& arguments,
                   const Console& console) {
    SoftBodies soft(made, robot, console);
    for (const std::string& muscle : arguments.muscles) soft.addMuscle(muscle);
    for (const std::string& skin : arguments.skins) soft.addSkin(skin, arguments.bones);
}

NamedMesh namedMesh(const std::string& text) {
    const auto sign = text.find('=');
    if (sign != text.npos && isPrimName(text.substr(0, sign)))
        return {text.substr(0, sign), text.substr(sign + 1)};
    return {std::filesystem::path(text).stem().string(), text};
}

} // namespace tss::tool
