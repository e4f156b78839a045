#include "bake/report/SkinStudy.h"

#include "bake/base/Parallel.h"
#include "bake/base/Stopwatch.h"
#include "bake/pipeline/BakeSkin.h"
#include "bake/report/Text.h"
#include "bake/search/SkinSearch.h"

#include <algorithm>

namespace tss::reporting {

std::string SkinStudy::partName() const {
    return bones == 0 ? "muscle" : muscles == 0 ? "bone" : "muscle or bone";
}

std::string SkinStudy::partCount() const {
    const std::string text = muscles > 0 || bones == 0 ? counted(muscles, "muscle") : "";
    return bones == 0 ? text : (text.empty() ? "" : text + " and ") + counted(bones, "bone");
}

namespace {

SkinStep makeStep(const SkinSetting& setting,
                  const std::vector<std::shared_ptr<const MuscleDeformer>>& deformers,
                  const std::vector<MuscleTrack>& tracks, const std::vector<SphereSet>& rest, double share) {
    SkinStep step;
    step.distances.assign(setting.skin.size(), std::numeric_limits<double>::infinity());
    std::vector<double> activations(deformers.size(), 0.0);
    for (std::size_t m = 0; m < deformers.size(); ++m) {
        const Muscle& muscle = deformers[m]->muscle();
        if (muscle.surface.empty()) continue;
        const double activation =
            muscle.activationLower + share * (muscle.activationUpper - muscle.activationLower);
        activations[m] = activation;
        const TrackPlace place = locate(tracks[m].nodes, activation);
        for (std::size_t s = 0; s < rest[m].size(); ++s)
            step.muscle.push_back({trackPosition(tracks[m], place, s),
                                   rest[m][s].radius * trackThickness(tracks[m], place, s)});
        TriangleMesh surface = deformers[m]->muscle().surface;
        surface.vertices = deformers[m]->vertices(activation);
        step.ellipsoids.push_back(compare::fitEllipsoid(surface));
        const MeshQuery query(surface);
        parallelFor(setting.skin.size(), [&](std::size_t v) {
            const Vec3& p = setting.skin[v].centre;
            const double distance = query.distance(p);
            step.distances[v] = std::min(step.distances[v], query.inside(p) ? -distance : distance);
        });
    }
    step.activation = meanActivation(deformers, activations);
    return step;
}

Table wholeTable(const SkinTable& skinTable, const std::vector<SphereSet>& rest,
                 std::vector<std::uint32_t>& rowVertex) {
    // The table keeps used spheres only: they are found again in the whole sets by their place at rest.
    std::vector<Sphere> all;
    for (const SphereSet& set : rest) all.insert(all.end(), set.begin(), set.end());
    Table table = skinTable.table;
    std::vector<std::uint32_t> index(table.b.size(), 0);
    for (std::size_t b = 0; b < table.b.size(); ++b)
        for (std::uint32_t s = 0; s < all.size(); ++s)
            if (all[s].centre == table.b[b].centre && all[s].radius == table.b[b].radius) index[b] = s;
    for (std::uint32_t& column : table.columns) column = index[column];
    rowVertex = skinTable.skinVertices;
    return table;
}

/// The muscles filled with spheres, and where these go.
struct MusclesInMotion {
    FilledMuscles filled;
    std::vector<SphereSet> rest; ///< one per muscle
    std::vector<MuscleTrack> tracks;
};

MusclesInMotion musclesInMotion(const SceneModel& scene, const SkinModel& skin, const BakeOptions& settings,
                                PairReport& notes) {
    MusclesInMotion muscles{fillMuscles(scene, skin, settings, notes), {}, {}};
    for (const SkinSearchMuscle& muscle : muscles.filled.searched) {
        muscles.rest.push_back(muscle.spheres);
        std::vector<MusclePoint> points;
        for (const Sphere& sphere : muscle.spheres) points.push_back(muscle.deformer->bind(sphere.centre));
        const Muscle& shape = muscle.deformer->muscle();
        muscles.tracks.push_back(makeTrack(*muscle.deformer, points,
                                           activationNodes(shape.activationLower, shape.activationUpper)));
    }
    return muscles;
}

/// The table as the paper makes it, of skin at its rest place.
SkinTable tableAtRest(const TriangleMesh& mesh, const SkinModel& skin, const FilledMuscles& filled,
                      SkinStudy& study) {
    SkinSearchOptions search;
    search.thickness = skin.thickness;
    search.path = SkinPath::AtRest;
    SkinTable table = searchSkin(mesh, filled.searched, search);
    study.skinSpheres = table.table.record.spheresA;
    study.usedSkin = table.table.a.size();
    study.usedMuscle = table.table.b.size();
    study.tests = table.table.testCount();
    return table;
}

/// What every method is asked about, at so many activations from the muscles' lower ends to their upper ones.
SkinSetting settingOf(const TriangleMesh& mesh, const SkinModel& skin, const SkinTable& atRest,
                      const MusclesInMotion& muscles, SkinStudy& study) {
    SkinSetting setting;
    study.thickness = skin.thickness > 0 ? skin.thickness : skinThickness(mesh);
    for (const Vec3& v : mesh.vertices) setting.skin.push_back({v, study.thickness});
    setting.table = wholeTable(atRest, muscles.rest, setting.rowVertex);
    for (int k = 0; k < study.activations; ++k) {
        const double share = study.activations > 1 ? static_cast<double>(k) / (study.activations - 1) : 0;
        setting.steps.push_back(
            makeStep(setting, muscles.filled.deformers, muscles.tracks, muscles.rest, share));
        study.activation.push_back(setting.steps.back().activation);
        for (const double distance : setting.steps.back().distances) {
            ++study.judged;
            study.touching += distance <= study.thickness ? 1 : 0;
        }
    }
    return setting;
}

} // namespace

SkinStudy studySkin(const SceneModel& scene, const SkinModel& skin, const ReportOptions& options,
                    const Progress& progress) {
    const Stopwatch watch;
    report(progress, skin.path + ": skin", 0);
    SkinStudy study;
    study.path = skin.path;
    study.millimetres = 1000 * scene.metersPerUnit;
    study.muscles = skin.muscles.size();
    study.bones = skin.bones.size();
    const TriangleMesh& mesh = scene.bodies[skin.body].mesh;
    const BakeOptions settings = optionsFor(skin.settings, {}, scene.metersPerUnit);
    PairReport notes;
    const MusclesInMotion muscles = musclesInMotion(scene, skin, settings, notes);
    for (const SphereSet& spheres : muscles.rest) study.muscleSpheres += spheres.size();
    if (!anyContracts(muscles.filled.deformers))
        study.activations = 1;
    else
        study.activations = options.quick ? 9 : 33;
    const SkinTable atRest = tableAtRest(mesh, skin, muscles.filled, study);

    SceneModel baked = scene;
    SkinModel carried = skin;
    bakeSkin(baked, carried, settings, notes, {});
    const UsedSpheres used = usedSpheres(carried.table->table);
    study.carriedSkin = used.a;
    study.carriedMuscle = used.b;
    study.carriedTests = carried.table->table.testCount();

    runSkinMethods(settingOf(mesh, skin, atRest, muscles, study), study);
    study.notRun.push_back(
        {"FCL, Bullet on the skin", "they answer for triangles of two rigid meshes; here each skin vertex "
                                    "needs its own verdict" +
                                        std::string(study.muscles ? " on a surface that deforms" : "")});
    study.notRun.push_back({"angular region, allowed paths, C-space grid",
                            std::string(study.muscles ? "one activation a muscle" : "one value a joint") +
                                " would fit a grid, but each of the vertices needs one of its own: that is a "
                                "stored animation, not a test"});
    report(progress, skin.path + ": skin in motion", 0.5);
    study.motion = studySkinMotion(scene, carried, muscles.filled.deformers, options.quick);
    study.seconds = watch.seconds();
    return study;
}

} // namespace tss::reporting
