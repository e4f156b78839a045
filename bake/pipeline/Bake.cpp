#include "bake/pipeline/Bake.h"

#include "bake/base/Error.h"
#include "bake/pipeline/BakePair.h"
#include "bake/pipeline/BakeSkin.h"

#include <algorithm>
#include <chrono>

namespace tss {

namespace {

using Clock = std::chrono::steady_clock;

bool wanted(const BakeRequest& request, const std::string& path) {
    return request.pairs.empty() ||
           std::find(request.pairs.begin(), request.pairs.end(), path) != request.pairs.end();
}

void checkPaths(const SceneModel& scene, const BakeRequest& request) {
    for (const std::string& path : request.pairs) {
        const auto same = [&](const auto& item) { return item.path == path; };
        if (std::none_of(scene.pairs.begin(), scene.pairs.end(), same) &&
            std::none_of(scene.skins.begin(), scene.skins.end(), same))
            throw InputError(Where{"", "", path}, "no pair and no skin of this path in the scene");
    }
}

/// Runs one bake and times it; an input error is told with the prim that it belongs to.
template <class Item, class Work>
PairReport timed(Item& item, const Work& work) {
    PairReport report;
    report.path = item.path;
    const auto start = Clock::now();
    try {
        work(report);
    } catch (const InputError& error) {
        if (!error.where.path.empty()) throw;
        throw InputError(Where{error.where.file, error.where.pointer, item.path}, error.message);
    }
    report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return report;
}

} // namespace

std::vector<PairReport> bake(SceneModel& scene, const BakeRequest& request, const Progress& progress) {
    checkPaths(scene, request);
    std::vector<PairReport> reports;
    for (Pair& pair : scene.pairs) {
        if (!wanted(request, pair.path)) continue;
        const BakeOptions options = optionsFor(pair.settings, request.given, scene.metersPerUnit);
        for (const auto& [key, text] : request.given) pair.settings[key] = text;
        reports.push_back(
            timed(pair, [&](PairReport& report) { bakePair(scene, pair, options, report, progress); }));
    }
    for (SkinModel& skin : scene.skins) {
        if (!wanted(request, skin.path)) continue;
        const BakeOptions options = optionsFor(skin.settings, request.given, scene.metersPerUnit);
        for (const auto& [key, text] : request.given) skin.settings[key] = text;
        reports.push_back(
            timed(skin, [&](PairReport& report) { bakeSkin(scene, skin, options, report, progress); }));
    }
    return reports;
}

} // namespace tss
