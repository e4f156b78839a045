#include "bake/tool/SceneMotion.h"

#include "bake/base/Error.h"
#include "bake/tool/CsvTable.h"
#include "bake/tool/DofSpec.h"

#include <algorithm>
#include <functional>

namespace tss::tool {

namespace {

/// What a column can drive.
struct Track {
    std::vector<std::string> names; ///< the last is what messages say
    TimeSamples* samples;
    std::function<double(double)> fromUser;
};

/// All of a scene, each without samples.
std::vector<Track> clearedTracks(SceneModel& scene) {
    const DofColumns columns = dofColumns(scene);
    std::vector<Track> tracks;
    for (Joint& joint : scene.joints) {
        joint.drives.assign(joint.dofs.size(), {});
        for (std::size_t k = 0; k < joint.dofs.size(); ++k) {
            const Dof& dof = joint.dofs[k];
            tracks.push_back({columns.names[tracks.size()], &joint.drives[k],
                              [&dof](double value) { return fromUser(dof, value); }});
        }
    }
    for (MuscleModel& muscle : scene.muscles) {
        muscle.activation = {};
        tracks.push_back({{primName(muscle.path)}, &muscle.activation, [](double value) { return value; }});
    }
    return tracks;
}

/// The track of each column but that of the time.
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
    std::vector<const Track*> columns;
    if (csv.header.empty())
        for (const Track& track : tracks) columns.push_back(&track);
    else
        columns = columnsOf(tracks, csv.header, timed, file);
    double before = 0;
    for (std::size_t r = 0; r < csv.rows.size(); ++r) {
        const std::vector<double>& row = csv.rows[r];
        if (row.size() != columns.size() + timed)
            throw InputError(Where{file}, "expected " + std::to_string(columns.size() + timed) +
                                              " columns, found " + std::to_string(row.size()));
        const double time = !timed    ? static_cast<double>(r)
                            : seconds ? row[0] * scene.timeCodesPerSecond
                                      : row[0];
        if (r > 0 && !(time > before)) throw InputError(Where{file}, "expected times that rise");
        before = time;
        if (r == 0) scene.startTimeCode = time;
        scene.endTimeCode = time;
        for (std::size_t k = 0; k < columns.size(); ++k) {
            columns[k]->samples->times.push_back(time);
            columns[k]->samples->values.push_back(columns[k]->fromUser(row[k + timed]));
        }
    }
}

} // namespace tss::tool
