#include "bake/tool/SceneMotion.h"

#include "bake/base/Error.h"
#include "bake/base/Stopwatch.h"
#include "bake/model/Kinematics.h"
#include "bake/play/Player.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss::tool {

std::vector<std::vector<double>> drivenSteps(const SceneModel& scene) {
    constexpr double most = 1e7;
    if (scene.endTimeCode - scene.startTimeCode > most)
        throw InputError(
            fmt::format("the motion goes over {:.3g} time codes, a step each; expected at most {:g}",
                        scene.endTimeCode - scene.startTimeCode, most));
    std::vector<std::vector<double>> steps;
    for (int k = 0; scene.startTimeCode + k <= scene.endTimeCode; ++k)
        steps.push_back(drivenValues(scene, scene.startTimeCode + k));
    return steps;
}

void addResiduals(Json& summary, const SceneModel& scene) {
    constexpr double patience = 20; // seconds
    const bool baked =
        std::ranges::any_of(scene.skins, [](const SkinModel& skin) { return skin.table != nullptr; });
    if (!baked) return;
    const auto steps = drivenSteps(scene);
    if (steps.size() < 2) return;
    std::vector<std::string> warnings; // of the pairs; `tss play` tells them
    Player player(scene, warnings);
    std::vector<double> deepest(scene.skins.size(), 0);
    std::size_t done = 0;
    const Stopwatch watch;
    while (done < steps.size() && watch.seconds() < patience) {
        const auto depths = player.step(steps[done], scene.startTimeCode + double(done)).residualDepths;
        for (std::size_t k = 0; k < depths.size(); ++k) deepest[k] = std::max(deepest[k], depths[k]);
        ++done;
    }
    for (std::size_t k = 0; k < scene.skins.size(); ++k) {
        if (!scene.skins[k].table) continue;
        summary["skins"][k]["residual"] = deepest[k];
        summary["skins"][k]["residualSteps"] = done;
    }
}

} // namespace tss::tool
