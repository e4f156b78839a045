#include "bake/pipeline/BakeSkin.h"

#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/model/SourceHash.h"
#include "bake/pipeline/FillPair.h"
#include "bake/play/SkinSetup.h"
#include "bake/respond/SkinMoves.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/spheres/RoundToFloat.h"

#include <algorithm>

namespace tss {

FilledMuscles fillMuscles(const SceneModel& scene, const SkinModel& skin, const BakeOptions& options,
                          PairReport& report, const Progress& progress) {
    FilledMuscles filled;
    filled.deformers = skinMuscles(scene, skin);
    const std::vector<UnderSkin> under = underSkin(scene, skin);
    for (std::size_t m = 0; m < under.size(); ++m) {
        const MuscleDeformer& deformer = *filled.deformers[m];
        const TriangleMesh& surface = deformer.muscle().surface;
        if (surface.empty()) {
            filled.searched.push_back({&deformer, {}});
            continue;
        }
        const SphereOptions how = sphereOptions(options, options.tolerance.value_or(diagonal(surface) / 100));
        const SphereFit fit = fitSpheres(cleaned(surface), how, progress);
        if (!fit.note.empty()) report.notes.push_back(pathOf(scene, under[m]) + ": " + fit.note);
        filled.searched.push_back({&deformer, roundToFloat(fit.spheres)});
    }
    return filled;
}

void bakeSkin(SceneModel& scene, SkinModel& skin, const BakeOptions& options, PairReport& report,
              const Progress& progress) {
    const TriangleMesh& mesh = scene.bodies[skin.body].mesh;
    if (mesh.empty()) throw InputError("expected a mesh, the skin has none");
    const FilledMuscles filled = fillMuscles(scene, skin, options, report, progress);
    SkinSearchOptions search;
    search.thickness = floatAbove(2 * (skin.thickness > 0 ? skin.thickness : skinThickness(mesh))) / 2.0;
    search.travel = skin.travel;
    std::vector<std::string> farTurns;
    const SkinParameters parameters = skinParameters(scene, skin, &farTurns);
    farTurns.erase(std::unique(farTurns.begin(), farTurns.end()), farTurns.end());
    for (const std::string& joint : farTurns)
        report.notes.push_back(joint +
                               " turns bones by more than half a turn from where it rests: beyond that "
                               "the skin between them jumps to the other way round");
    SkinMoves moves = skinMoves(mesh, filled.deformers, parameters);
    search.stray = std::move(moves.stray);
    search.shares = std::move(moves.shares);
    search.swings = parameters.swings;
    search.insertions = parameters.insertions;
    SkinSearchCounts counts;
    auto table = std::make_shared<SkinTable>(searchSkin(mesh, filled.searched, search, progress, &counts));
    if (counts.stopped) throw InputError("stopped before the table was complete");
    table->table.record.spheresA = counts.skinSpheres;
    table->table.record.spheresB = counts.muscleSpheres;
    table->table.record.candidatePairs = counts.tests;
    skin.table = table;
    skin.sourceHash = sourceHash(scene, skin);
}

} // namespace tss
