#include "bake/pipeline/BakeSkin.h"

#include "bake/base/Error.h"
#include "bake/bind/SkinMoves.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/model/SourceHash.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MuscleSpan.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/pipeline/FillPair.h"
#include "bake/play/MuscleWays.h"
#include "bake/play/SkinSetup.h"
#include "bake/spheres/GenerateSpheres.h"
#include "bake/spheres/Patches.h"
#include "bake/spheres/RoundToFloat.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace tss {
namespace {

/// The spheres of what lies under a skin. They only tell what the skin may meet: where the tolerance, which
/// may be meant for pairs, is too fine for them, the usual one serves.
SphereFit fitUnder(const TriangleMesh& surface, const BakeOptions& options, double metersPerUnit,
                   std::vector<std::string>& notes, const Progress& progress) {
    const double usual = diagonal(surface) / 100, asked = options.tolerance.value_or(usual);
    const auto fit = [&](double tolerance) {
        SphereFit made = fitSpheres(cleaned(surface), sphereOptions(options, tolerance), progress);
        if (!made.note.empty()) notes.push_back(made.note);
        return made;
    };
    try {
        return fit(asked);
    } catch (const TooFine&) {
        if (asked >= usual) throw;
    }
    notes.push_back(fmt::format("a tolerance of {} in place of {}, which takes too many patches; skin meets "
                                "the mesh itself",
                                lengthText(usual, metersPerUnit), lengthText(asked, metersPerUnit)));
    return fit(usual);
}

constexpr double worthSaying = 0.01; ///< of the volume

/// By how much of its volume a muscle is off at worst where its bones come to, at rest and fully active.
double worstVolume(const MuscleDeformer& muscle, const MuscleWays& ways, const Pose& toSkin) {
    const MuscleSpan span(muscle);
    const std::vector<Tri>& triangles = muscle.closedTriangles();
    double worst = 0;
    for (const double activation : {muscle.muscle().activationLower, muscle.muscle().activationUpper}) {
        const std::vector<Vec3> rest = muscle.vertices(activation);
        for (const std::vector<DualPose>& motion : ways.motions) {
            ChainMotion bones;
            for (const DualPose& bone : motion) {
                PoseBlend blend(true);
                blend.add(1, bone);
                bones.push_back(toSkin * blend.pose() * toSkin.inverse(Eigen::Isometry));
            }
            std::vector<Vec3> places = rest;
            span.carry(bones, places);
            const double off = enclosedVolume(places, triangles) / muscle.restVolume() - 1;
            if (std::abs(off) > std::abs(worst)) worst = off;
        }
    }
    return worst;
}

/// Notes about the muscles over several bones that lie under a skin: those that cannot keep their volume
/// everywhere within the joints' limits, and those that are turned so far that it is ambiguous which way
/// round their bones have come.
std::vector<std::string> muscleNotes(const SceneModel& scene, const SkinModel& skin,
                                     const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles) {
    std::vector<std::string> notes;
    const std::vector<UnderSkin> under = underSkin(scene, skin);
    for (std::size_t m = 0; m < under.size(); ++m) {
        if (under[m].muscle < 0 || under[m].chain.empty() || under[m].bone < 0) continue;
        const MuscleModel& model = scene.muscles[under[m].muscle];
        const MuscleWays ways = muscleWays(scene, model);
        if (ways.unclear)
            notes.push_back(model.path + " is turned by more than half a turn either way, or nearly all the "
                                         "way round, by the joints between its bones: there it jumps from "
                                         "one way round to the other");
        const Pose toSkin =
            scene.bodies[skin.body].placement.inverse(Eigen::Isometry) * scene.bodies[model.body].placement;
        if (const double worst = worstVolume(*muscles[m], ways, toSkin); std::abs(worst) > worthSaying)
            notes.push_back(fmt::format("{} cannot keep its volume within the limits of the joints between "
                                        "its bones: {:+.0f} % where they draw it together or apart the most",
                                        model.path, 100 * worst));
    }
    return notes;
}

} // namespace

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
        std::vector<std::string> notes;
        const SphereFit fit = fitUnder(surface, options, scene.metersPerUnit, notes, progress);
        for (const std::string& note : notes) report.notes.push_back(pathOf(scene, under[m]) + ": " + note);
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
    for (const std::string& note : muscleNotes(scene, skin, filled.deformers)) report.notes.push_back(note);
    SkinMoves moves = skinMoves(mesh, filled.deformers, parameters);
    search.stray = std::move(moves.stray);
    search.shares = std::move(moves.shares);
    search.swings = parameters.swings;
    search.swings.insert(search.swings.end(), parameters.together.begin(), parameters.together.end());
    search.chains = parameters.chains;
    skin.table = std::make_shared<SkinTable>(searchSkin(mesh, filled.searched, search, progress));
    skin.sourceHash = sourceHash(scene, skin);
}

} // namespace tss
