#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/FramePattern.h"
#include "bake/base/Words.h"
#include "bake/model/SourceHash.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/WholeTurn.h"
#include "bake/pipeline/BakeOptions.h"
#include "bake/play/Player.h"
#include "bake/respond/SkinCosts.h"
#include "bake/respond/SkinFollowMeasure.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/Command.h"
#include "bake/tool/CsvTable.h"
#include "bake/tool/DofSpec.h"
#include "bake/tool/SceneMotion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <numeric>
#include <span>

namespace tss::tool {

namespace {

struct PlayArguments {
    std::string scene, motion, output, meshes;
    bool timings = false;
};

/// The asked DOF values of all joints, one row a step; joints in file order, DOFs in the joint's order.
DofRows askedSteps(const SceneModel& scene, const PlayArguments& arguments) {
    if (arguments.motion.empty()) return {drivenSteps(scene), {}};
    return readDofRows(arguments.motion, dofColumns(scene), true);
}

/// Whether values of a joint's DOFs lie outside its limits or planes by more than rounding.
bool isOutside(const Joint& joint, std::span<const double> values) {
    constexpr double rounding = 1e-6; // of a DOF's range
    for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
        const Dof& dof = joint.dofs[k];
        if (wholeTurn(dof) && joint.planes.empty()) continue; // no end
        const double slack = rounding * (dof.upper - dof.lower);
        if (values[k] < dof.lower - slack || values[k] > dof.upper + slack) return true;
    }
    return std::ranges::any_of(joint.planes, [&](const LimitPlane& plane) {
        double excess = -plane.bound - 1e-12 * std::abs(plane.bound);
        for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
            const double slack = rounding * (joint.dofs[k].upper - joint.dofs[k].lower);
            excess += plane.coefficients[k] * values[k] - std::abs(plane.coefficients[k]) * slack;
        }
        return excess > 0;
    });
}

/// How many steps ask for a pose outside of what some joint allows.
std::size_t countOutside(const SceneModel& scene, const std::vector<std::vector<double>>& steps) {
    return static_cast<std::size_t>(std::ranges::count_if(steps, [&](const std::vector<double>& step) {
        std::span<const double> rest(step);
        return std::ranges::any_of(scene.joints, [&](const Joint& joint) {
            const auto values = rest.first(joint.dofs.size());
            rest = rest.subspan(joint.dofs.size());
            return isOutside(joint, values);
        });
    }));
}

/// All bodies in one OBJ with a group each.
std::string objText(const SceneModel& scene, const std::vector<TriangleMesh>& meshes) {
    std::string text;
    std::size_t first = 1;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
        if (meshes[k].empty()) continue;
        const std::string& path = scene.bodies[k].path;
        text += fmt::format("g {}\n", primName(path));
        for (const Vec3& x : meshes[k].vertices) text += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
        for (const Tri& t : meshes[k].triangles)
            text += fmt::format("f {} {} {}\n", first + t[0], first + t[1], first + t[2]);
        first += meshes[k].vertices.size();
    }
    return text;
}

std::string header(const SceneModel& scene) {
    std::string text = "step";
    for (const char* prefix : {"asked_", ""})
        for (const Joint& joint : scene.joints)
            for (const Dof& dof : joint.dofs)
                text += fmt::format(",{}{}:{}", prefix, primName(joint.path), dof.name);
    text += ",table_gap,status";
    for (const SkinModel& skin : scene.skins) text += fmt::format(",residual_{}", primName(skin.path));
    return text + "\n";
}

/// One line of the result: asked and resolved values as people write them.
std::string line(const SceneModel& scene, std::size_t number, const std::vector<double>& asked,
                 const Player::Step& step) {
    std::string text = std::to_string(number);
    for (const auto* row : {&asked, &step.values}) {
        std::size_t column = 0;
        for (const Joint& joint : scene.joints)
            for (const Dof& dof : joint.dofs) text += fmt::format(",{:.15g}", toUser(dof, (*row)[column++]));
    }
    text += std::isfinite(step.gap) ? fmt::format(",{}", step.gap) : ","; // no table has a test
    text += fmt::format(",{}", name(step.status));
    for (double depth : step.residualDepths) text += fmt::format(",{}", depth);
    return text + "\n";
}

/// What came of all steps together.
struct Totals {
    struct OfSkin {
        double seconds = 0;
        double pushed = 0;   ///< at worst
        SkinFollowing worst; ///< how it follows its bones
    };
    std::map<std::string, int> statuses;
    double deepest = 0, jointSeconds = 0;
    std::vector<OfSkin> skins;

    void add(const Player::Step& step, const std::vector<SkinFollowing>& following) {
        ++statuses[name(step.status)];
        jointSeconds += step.jointSeconds;
        for (std::size_t k = 0; k < skins.size(); ++k) {
            skins[k].seconds += step.skinSeconds[k];
            skins[k].pushed = std::max(skins[k].pushed, step.pushed[k]);
            skins[k].worst.worsen(following[k]);
            deepest = std::max(deepest, step.residualDepths[k]);
        }
    }
};

/// What a skin has done at worst, in words and as data.
nlohmann::json sayFollowing(const SceneModel& scene, const SkinModel& skin, const SkinFollowing& worst,
                            double pushed, const Console& console) {
    console.say(fmt::format("  {}: edges {:.2f} to {:.2f} of their length at rest (1st and 99th percentile), "
                            "{} triangles turned over, moved by contacts by {}, at worst",
                            skin.path, worst.shortest, worst.longest, worst.turnedOver,
                            lengthText(pushed, scene.metersPerUnit)));
    nlohmann::json bones = nlohmann::json::array();
    const std::vector<UnderSkin> under = underSkin(scene, skin);
    for (std::size_t m = 0; m < worst.bones.size(); ++m) {
        const SkinFollowing::OnBone& bone = worst.bones[m];
        if (bone.vertices == 0) continue;
        const std::string& path = scene.bodies[under[m].body].path;
        console.say(fmt::format("    on {} alone, {} vertices: off its motion by {:.2g} on average, 95 % "
                                "within {:.2g} (thousandths of the bones' size)",
                                path, bone.vertices, bone.mean, bone.most));
        bones.push_back(
            {{"bone", path}, {"vertices", bone.vertices}, {"mean", bone.mean}, {"within95", bone.most}});
    }
    return {{"skin", skin.path},
            {"edges", {worst.shortest, worst.longest}},
            {"turnedOver", worst.turnedOver},
            {"pushed", pushed},
            {"bones", bones}};
}

/// What a step costs on one core, in words; the tool's own measuring of depths is not in it.
std::string costText(const SceneModel& scene, std::size_t steps, const Totals& totals) {
    const auto each = static_cast<double>(std::max<std::size_t>(steps, 1));
    std::string text =
        fmt::format("  a step costs {:.3g} us for the joints", 1e6 * totals.jointSeconds / each);
    for (std::size_t k = 0; k < totals.skins.size(); ++k)
        text += fmt::format(", {:.3g} ms for {}", 1e3 * totals.skins[k].seconds / each, scene.skins[k].path);
    return text + ", on one core";
}

/// What the parts of a skin's updates cost, in words and as data. seconds: of this core, for all of them, of
/// which the parts have their shares, whatever else the machine does meanwhile.
nlohmann::json sayParts(const SkinModel& skin, const SkinCosts& costs, double seconds,
                        const Console& console) {
    // In the order of SkinPart.
    constexpr std::array<std::pair<const char*, const char*>, skinParts> names{
        {{"carry", "muscles and bones placed, skin carried"},
         {"sort", "which contacts may have met"},
         {"bones", "look-ups at bones"},
         {"muscles", "look-ups at muscles"},
         {"folds", "look-ups of the skin at itself"},
         {"pushes", "contacts solved, skin moved by them"},
         {"show", "places and normals handed out"}}};
    const auto updates = static_cast<double>(std::max<std::size_t>(costs.updates, 1));
    nlohmann::json parts = {{"updates", costs.updates}, {"lookUps", costs.lookUps}};
    console.say(fmt::format("  {}: {} updates moved it, with {:.0f} look-ups and {:.3g} ms each, of which",
                            skin.path, costs.updates, static_cast<double>(costs.lookUps) / updates,
                            1e3 * seconds / updates));
    const double all = std::accumulate(costs.seconds.begin(), costs.seconds.end(), 0.0);
    for (std::size_t p = 0; p < skinParts; ++p) {
        const double each = all > 0 ? costs.seconds[p] / all * seconds / updates : 0;
        console.say(fmt::format("    {:<40}{:>8.3f} ms", names[p].second, 1e3 * each));
        parts[names[p].first] = each;
    }
    return parts;
}

/// What is played though nothing was baked for it, in words.
std::vector<std::string> unbaked(const SceneModel& scene) {
    std::vector<std::string> warnings, pairs;
    for (const Pair& pair : scene.pairs)
        if (!pair.table && !pair.proof) pairs.push_back(pair.path);
    if (!pairs.empty())
        warnings.push_back("not kept apart: " + counted(pairs.size(), "pair") +
                           " without a table, which tss bake makes: " + firstOf(pairs, 10));
    for (const SkinModel& skin : scene.skins)
        if (!skin.table)
            warnings.push_back(
                "skin " + skin.path +
                " is carried, but not kept out of what is below it: it has no table, tss bake makes one");
    return warnings;
}

/// What came of all steps, in words, and of the skins as data. costs: one a skin; empty: not measured.
nlohmann::json sayTotals(const SceneModel& scene, std::size_t steps, const Totals& totals,
                         const std::vector<SkinCosts>& costs, const Console& console) {
    for (const auto& [status, count] : totals.statuses) console.say(fmt::format("  {:<10}{}", status, count));
    console.say(costText(scene, steps, totals));
    if (!scene.skins.empty())
        console.say("  deepest residual of a skin " + lengthText(totals.deepest, scene.metersPerUnit) +
                    ": so far it is in what is below it, beyond its depth at rest");
    nlohmann::json skins = nlohmann::json::array();
    for (std::size_t k = 0; k < totals.skins.size(); ++k) {
        const auto& [seconds, pushed, worst] = totals.skins[k];
        skins.push_back(sayFollowing(scene, scene.skins[k], worst, pushed, console));
        if (!costs.empty()) skins.back()["costs"] = sayParts(scene.skins[k], costs[k], seconds, console);
    }
    return skins;
}

void play(const PlayArguments& arguments, const Console& console) {
    refuseOverwriting(arguments.output, {arguments.scene, arguments.motion});
    if (!arguments.output.empty()) expectText(arguments.output);
    if (!arguments.meshes.empty() &&
        !(isFramePattern(arguments.meshes) && arguments.meshes.ends_with(".obj")))
        throw InputError("--mesh-out: expected a name with a number in it, like f_%04d.obj, found \"" +
                         arguments.meshes + "\"");
    const SceneModel scene = loadScene(arguments.scene);
    requireFresh(scene, arguments.scene);
    const auto [steps, remark] = askedSteps(scene, arguments);
    std::vector<std::string> warnings = unbaked(scene);
    if (!remark.empty()) warnings.push_back(remark);
    Player player = inFile(arguments.scene, [&] { return Player(scene, warnings); });
    const std::size_t outside = countOutside(scene, steps);
    if (outside > 0)
        warnings.push_back(fmt::format(
            "{} of {} steps ask for more than the limits of a joint allow: they end at the limits", outside,
            steps.size()));
    for (const std::string& warning : warnings) console.say(warning);

    std::vector<SkinCosts> costs(arguments.timings ? scene.skins.size() : 0);
    if (arguments.timings) player.charge(costs);
    std::string text = header(scene);
    Totals totals;
    totals.skins.resize(scene.skins.size());
    for (std::size_t k = 0; k < steps.size(); ++k) {
        const Player::Step step = player.step(steps[k], scene.startTimeCode + static_cast<double>(k));
        text += line(scene, k, steps[k], step);
        totals.add(step, player.following());
        if (!arguments.meshes.empty())
            writeFileAtomically(frameName(arguments.meshes, static_cast<unsigned int>(k)),
                                objText(scene, player.worldMeshes()));
    }
    if (!arguments.output.empty()) writeFileAtomically(arguments.output, text);
    console.say(fmt::format("{}{}", counted(steps.size(), "step"),
                            arguments.output.empty() ? "" : ", wrote " + arguments.output));
    const nlohmann::json skins = sayTotals(scene, steps.size(), totals, costs, console);
    console.print({{"steps", steps.size()},
                   {"statuses", totals.statuses},
                   {"skins", skins},
                   {"outsideLimits", outside},
                   {"residualDepth", totals.deepest},
                   {"warnings", warnings},
                   {"output", arguments.output}});
}

} // namespace

void addPlay(CLI::App& app, Console& console) {
    CLI::App* command = addCommand(app, console, "play", "resolves a motion step by step");
    auto arguments = std::make_shared<PlayArguments>();
    command->add_option("scene", arguments->scene, "a baked scene")->required();
    command->add_option("--motion", arguments->motion,
                        "CSV, one row a step, one column a DOF of the joints in file order (default: the "
                        "scene's own drives)");
    command->add_option(
        "-o,--output", arguments->output,
        "CSV: step, asked and resolved DOFs, table_gap, status, and of each skin residual_NAME: how deep it "
        "is in what is below it, beyond its depth at rest, scene units (default: only what is said in sum)");
    command->add_flag("--timings", arguments->timings,
                      "also what each part of a skin's update costs, which makes the updates a tenth slower");
    command->add_option("--mesh-out", arguments->meshes, "also the posed meshes, like f_%04d.obj");
    command->callback([arguments, &console] { play(*arguments, console); });
}

} // namespace tss::tool
