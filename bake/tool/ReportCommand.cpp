#include "bake/base/Error.h"
#include "bake/report/Report.h"
#include "bake/scene/SceneFile.h"
#include "bake/tool/Command.h"
#include "bake/tool/CsvTable.h"
#include "bake/tool/DofSpec.h"

#include <fmt/format.h>
#include <memory>

namespace tss::tool {

namespace {

struct ReportArguments {
    std::string scene, output;
    reporting::ReportOptions options;
};

/// The steps of a motion for the one pair it is for.
std::vector<std::vector<double>> readMotion(const SceneModel& scene, const ReportArguments& arguments) {
    const std::vector<std::string>& paths = arguments.options.pairs;
    const Pair* pair = nullptr;
    for (const Pair& candidate : scene.pairs)
        if (paths.empty() || (paths.size() == 1 && paths[0] == candidate.path)) {
            if (pair)
                throw InputError(arguments.scene +
                                 ": expected --pair with --motion, the scene has several pairs");
            pair = &candidate;
        }
    if (!pair) throw InputError(arguments.scene + ": expected a pair of rigid bodies for --motion");
    const auto rows = readDofRows(arguments.options.motionFile, dofColumns(scene, *pair), true).rows;
    const Motion motion = pairMotion(scene, *pair);
    for (std::size_t row = 0; row < rows.size(); ++row)
        if (beyondLimits(motion, rows[row]))
            throw InputError(fmt::format(
                "{}: row {} is outside the limits ({}), where no table says anything",
                arguments.options.motionFile, row + 1, describeDofs(motion, scene.metersPerUnit)));
    return rows;
}

Json summary(const reporting::Report& report, const std::string& folder) {
    Json json{
        {"output", folder}, {"seconds", report.seconds}, {"pairs", Json::array()}, {"skins", Json::array()}};
    for (const auto& pair : report.pairs) {
        Json rows = Json::array();
        for (const auto& row : pair.rows)
            rows.push_back({{"method", row.method},
                            {"setting", row.setting},
                            {"missed", row.misses()},
                            {"worstMm", row.worst() * pair.millimetres},
                            {"nanoseconds", row.times.median}});
        json["pairs"].push_back(
            {{"path", pair.path}, {"neverCollides", pair.never.has_value()}, {"methods", rows}});
    }
    for (const auto& skin : report.skins)
        json["skins"].push_back({{"path", skin.path},
                                 {"tests", skin.tests},
                                 {"skinSpheres", skin.skinSpheres},
                                 {"muscleSpheres", skin.muscleSpheres}});
    return json;
}

void runReport(ReportArguments& arguments, const Console& console) {
    const SceneModel scene = loadScene(arguments.scene);
    if (!arguments.options.motionFile.empty()) arguments.options.motion = readMotion(scene, arguments);
    const reporting::Report report = reporting::makeReport(scene, arguments.scene, arguments.output,
                                                           arguments.options, console.progress());
    std::size_t methods = 0;
    for (const auto& pair : report.pairs) methods += pair.rows.size();
    for (const auto& skin : report.skins) methods += skin.methods.size();
    if (!report.plotProblem.empty()) console.say(report.plotProblem);
    console.say(fmt::format("{} and {}, {} in {:.0f} s, wrote {}/index.html and report.md",
                            counted(report.pairs.size(), "pair"), counted(report.skins.size(), "skin"),
                            counted(methods, "row"), report.seconds, arguments.output));
    console.print(summary(report, arguments.output));
}

} // namespace

void addReport(CLI::App& app, Console& console) {
    CLI::App* command =
        addCommand(app, console, "report", "error against run time: this method and all others, as a folder");
    auto arguments = std::make_shared<ReportArguments>();
    command->add_option("scene", arguments->scene, "a scene, baked or not")->required();
    command
        ->add_option("-o,--output", arguments->output,
                     "folder for index.html, report.md, report.json, report.csv and plots")
        ->required();
    command
        ->add_option("--pair", arguments->options.pairs,
                     "prim path of a pair or skin (repeat; all when not given)")
        ->allow_extra_args(false);
    command->add_option(
        "--motion", arguments->options.motionFile,
        "CSV, one column a DOF (degrees, or the DOF's own unit): the steps to count tests along");
    command->add_option("--methods", arguments->options.methods, "parts of the names of the methods wanted")
        ->delimiter(',')
        ->allow_extra_args(false);
    command->add_option("--seed", arguments->options.seed, "of the random poses")
        ->check([](const std::string& text) {
            return std::string(text.starts_with('-') ? "expected a whole number from 0 on" : "");
        });
    command->add_flag("--quick", arguments->options.quick, "fewer poses and settings, a minute or two");
    command->add_flag("--beside-paper", arguments->options.besidePaper,
                      "also the paper's own counts and the goals of osgTSS, as docs/REPORT.md has them");
    command->callback([arguments, &console] { runReport(*arguments, console); });
}

} // namespace tss::tool
