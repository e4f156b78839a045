#include "bake/BakePair.h"
#include "bake/SkinSetup.h"
#include "bake/base/Error.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/scene/SourceHash.h"
#include "bake/search/SkinSearch.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/spheres/RoundToFloat.h"

namespace tss {

void bakeSkin(SceneModel& scene, SkinModel& skin, const BakeOptions& options, PairReport& report,
              const Progress& progress) {
    const TriangleMesh& mesh = scene.bodies[skin.body].mesh;
    if (mesh.empty()) throw InputError("expected a mesh, the skin has none");
    const auto deformers = skinMuscles(scene, skin);
    std::vector<SkinSearchMuscle> muscles;
    for (const auto& deformer : deformers) {
        const TriangleMesh& surface = deformer->muscle().surface;
        SphereOptions how;
        how.method = options.spheres;
        how.tolerance = options.tolerance.value_or(bounds(surface).diagonal().norm() / 100);
        how.maxSpheres = options.maxSpheres;
        how.conservative = options.conservative;
        const SphereFit fit = fitSpheres(cleaned(surface), how, progress);
        if (!fit.note.empty()) report.notes.push_back(fit.note);
        muscles.push_back({deformer.get(), roundToFloat(fit.spheres)});
    }
    SkinSearchOptions search;
    search.thickness = floatAbove(2 * (skin.thickness > 0 ? skin.thickness : skinThickness(mesh))) / 2.0;
    search.travel = skin.travel;
    SkinSearchCounts counts;
    auto table = std::make_shared<SkinTable>(searchSkin(mesh, muscles, search, progress, &counts));
    if (counts.stopped) throw InputError("stopped before the table was complete");
    table->table.record.spheresA = counts.skinSpheres;
    table->table.record.spheresB = counts.muscleSpheres;
    table->table.record.candidatePairs = counts.tests;
    skin.table = table;
    skin.sourceHash = sourceHash(scene, skin);
}

} // namespace tss
