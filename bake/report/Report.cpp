#include "bake/report/Report.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"
#include "bake/base/Stopwatch.h"
#include "bake/pipeline/Bake.h"
#include "bake/report/MethodSet.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace tss::reporting {

namespace {

std::string stemOf(const std::string& path, bool alone) {
    if (alone) return "";
    std::string stem = path.substr(1);
    std::ranges::replace(stem, '/', '-');
    return stem + "-";
}

void checkPaths(const SceneModel& scene, const ReportOptions& options, const std::string& file) {
    if (scene.pairs.empty() && scene.skins.empty())
        throw InputError(Where{file}, "expected a scene with a pair or a skin to report on");
    expectPaths(scene, options.pairs, file);
}

void checkMethods(const std::vector<std::string>& wanted) {
    for (const std::string& part : wanted) {
        if (part.empty()) throw InputError("--methods: expected parts of names, found an empty one");
        if (part.find(' ') != part.npos || methodNames().find(part) == part.npos)
            throw InputError(fmt::format("--methods: no method has \"{}\" in its name; expected parts of {}",
                                         part, methodNames()));
    }
}

} // namespace

Report makeReport(const SceneModel& scene, const std::string& sceneFile, const std::string& folder,
                  const ReportOptions& options, const Progress& progress) {
    checkPaths(scene, options, sceneFile);
    checkMethods(options.methods);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw InputError(Where{folder}, "cannot make the folder: " + error.message());
    std::filesystem::create_directory(folder + "/plots", error);
    for (const char* file : {"/plots/pareto.svg", "/report.csv", "/report.json", "/report.md", "/index.html"})
        expectWritable(folder + file);
    const Stopwatch watch;
    Report result;
    result.scene = std::filesystem::path(sceneFile).filename().string();
    result.machine = compare::thisMachine();
    result.options = options;
    const auto wanted = [&](const std::string& path) {
        return options.pairs.empty() || std::ranges::find(options.pairs, path) != options.pairs.end();
    };
    for (const Pair& pair : scene.pairs) {
        if (!wanted(pair.path)) continue;
        result.pairs.push_back(studyPair(scene, pair, options, progress));
        result.pairPictures.push_back(picturesOf(scene, pair, result.pairs.back().leading));
    }
    for (const SkinModel& skin : scene.skins)
        if (wanted(skin.path)) result.skins.push_back(studySkin(scene, skin, options, progress));
    const bool alone = result.pairs.size() + result.skins.size() == 1;
    for (const PairStudy& study : result.pairs)
        result.pairPlots.push_back(
            study.never ? std::vector<Plot>{}
                        : drawPlots(study, folder, stemOf(study.path, alone), result.plotProblem));
    for (const SkinStudy& study : result.skins)
        result.skinPlots.push_back(drawPlots(study, folder, stemOf(study.path, alone), result.plotProblem));
    result.seconds = watch.seconds();
    writeFileAtomically(folder + "/report.csv", csvOf(result));
    writeFileAtomically(folder + "/report.json", jsonText(result));
    writeFileAtomically(folder + "/report.md", markdownOf(result));
    writeFileAtomically(folder + "/index.html", pageOf(result));
    return result;
}

} // namespace tss::reporting
