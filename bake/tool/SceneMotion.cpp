#include "bake/tool/SceneMotion.h"

#include "bake/base/Error.h"
#include "bake/base/Stopwatch.h"
#include "bake/model/Kinematics.h"
#include "bake/play/Player.h"
#include "bake/tool/CsvTable.h"
#include "bake/tool/DofSpec.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss::tool {

namespace {

/// What a column can drive.
struct Track {
    std::vector<std::string> names; ///< the last is what messages say
    TimeSamples* samples;
    const Dof* dof; ///< null: of a muscle
};

/// Removes the samples of all drives and activations of a scene, and returns these to be filled again.
std::vector<Track> clearedTracks(SceneModel& scene) {
    const DofColumns columns = dofColumns(scene);
    std::vector<Track> tracks;
    for (Joint& joint : scene.joints) {
        joint.drives.assign(joint.dofs.size(), {});
        for (std::size_t k = 0; k < joint.dofs.size(); ++k)
            tracks.push_back({columns.names[tracks.size()], &joint.drives[k], &joint.dofs[k]});
    }
    for (MuscleModel& muscle : scene.muscles) {
        muscle.activation = {};
        tracks.push_back({{primName(muscle.path)}, &muscle.activation, nullptr});
    }
    return tracks;
}

/// The track that each column from the `first` on drives. Throws InputError for a name that is no track's.
std::vector<const Track*> columnsOf(const std::vector<Track>& tracks, const std::vector<std::string>& header,
                                    std::size_t first, const std::string& file) {
    std::vector<const Track*> columns;
    std::vector<std::vector<std::string>> words;
    for (const Track& track : tracks) words.push_back(track.names);
    for (std::size_t k = first; k < header.size(); ++k) {
        const std::size_t found = columnNamed(words, header[k]);
        if (found == tracks.size()) {
            std::string names;
            for (const Track& track : tracks) names += (names.empty() ? "" : ", ") + track.names.back();
            throw InputError(Where{file},
                             "no joint or muscle is called \"" + header[k] + "\"; expected some of " + names);
        }
        if (std::ranges::find(columns, &tracks[found]) != columns.end())
            throw InputError(Where{file}, "expected one column of " + header[k]);
        columns.push_back(&tracks[found]);
    }
    return columns;
}

} // namespace

void applyMotion(SceneModel& scene, const std::string& file) {
    const CsvTable csv = readCsv(file);
    const std::vector<Track> tracks = clearedTracks(scene);
    const bool seconds = !csv.header.empty() && isTime(csv.header[0]),
               timed = seconds || (!csv.header.empty() && isStep(csv.header[0]));
    const std::size_t first = timed ? 1 : 0; // column that drives something
    std::vector<const Track*> columns;
    if (csv.header.empty())
        for (const Track& track : tracks) columns.push_back(&track);
    else
        columns = columnsOf(tracks, csv.header, first, file);
    for (std::size_t r = 0; r < csv.rows.size(); ++r) {
        const std::vector<double>& row = csv.rows[r];
        if (row.size() != columns.size() + first)
            throw InputError(Where{file}, "expected " + std::to_string(columns.size() + first) +
                                              " columns, found " + std::to_string(row.size()));
        const double time = !timed    ? static_cast<double>(r)
                            : seconds ? row[0] * scene.timeCodesPerSecond
                                      : row[0];
        if (r > 0 && !(time > scene.endTimeCode)) throw InputError(Where{file}, "expected times that rise");
        if (r == 0) scene.startTimeCode = time;
        scene.endTimeCode = time;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const auto& [names, samples, dof] = *columns[k];
            samples->times.push_back(time);
            samples->values.push_back(dof ? fromUser(*dof, row[k + first]) : row[k + first]);
        }
    }
}

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
