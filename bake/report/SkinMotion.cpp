#include "bake/report/SkinMotion.h"

#include "bake/base/Parallel.h"
#include "bake/geometry/Solid.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/play/SkinSetup.h"
#include "bake/report/Timing.h"
#include "bake/respond/SkinResponse.h"

#include <algorithm>
#include <cmath>

namespace tss::reporting {

namespace {

using Muscles = std::vector<std::shared_ptr<const MuscleDeformer>>;
using Activations = std::vector<double>;

/// The scene's own activations, or all of them from their lower end to their upper one and back.
std::vector<Activations> motionOf(const SceneModel& scene, const SkinModel& skin, const Muscles& muscles,
                                  int steps, std::string& inWords) {
    std::vector<Activations> asked;
    bool animated = scene.endTimeCode > scene.startTimeCode;
    if (animated) {
        for (int s = 0; s < steps; ++s)
            asked.push_back(skinActivations(scene, skin,
                                            scene.startTimeCode +
                                                (scene.endTimeCode - scene.startTimeCode) * s / (steps - 1)));
        animated = std::ranges::any_of(asked, [&](const Activations& a) { return a != asked[0]; });
    }
    inWords = animated ? "the scene's own animation" : "all activations up and down again";
    if (animated) return asked;
    asked.clear();
    for (int s = 0; s < steps; ++s) {
        Activations a;
        for (const auto& muscle : muscles) {
            const double low = std::max(0.0, muscle->muscle().activationLower),
                         high = muscle->muscle().activationUpper;
            a.push_back(low + (1 - std::abs(1 - 2.0 * s / (steps - 1))) * (high - low));
        }
        asked.push_back(std::move(a));
    }
    return asked;
}

/// The muscles' surfaces at one step.
struct Truth {
    std::vector<Solid> solids;

    double depth(const Vec3& p) const {
        double deepest = 0;
        for (const Solid& solid : solids)
            if (solid.inside(p)) deepest = std::max(deepest, solid.boundary().distance(p));
        return deepest;
    }
    std::vector<double> depths(std::span<const Vec3> positions) const {
        std::vector<double> each(positions.size());
        parallelFor(each.size(), [&](std::size_t i) { each[i] = depth(positions[i]); });
        return each;
    }
};

Truth truthAt(const Muscles& muscles, const Activations& activations) {
    Truth truth;
    for (std::size_t m = 0; m < muscles.size(); ++m) {
        if (muscles[m]->muscle().surface.empty()) continue; // moves skin and has no shape
        truth.solids.emplace_back(
            TriangleMesh{muscles[m]->vertices(activations[m]), muscles[m]->muscle().surface.triangles});
    }
    return truth;
}

/// How much deeper than at rest the deepest is.
double deepestBeyond(const std::vector<double>& now, const std::vector<double>& rest) {
    double deepest = 0;
    for (std::size_t i = 0; i < now.size(); ++i) deepest = std::max(deepest, now[i] - rest[i]);
    return deepest;
}

double areaOf(std::span<const Vec3> positions, const std::vector<Tri>& triangles) {
    double area = 0;
    for (const Tri& t : triangles) {
        const Vec3& a = positions[t[0]];
        area += 0.5 * (positions[t[1]] - a).cross(positions[t[2]] - a).norm();
    }
    return area;
}

/// Where a response has the vertices of another's rig: those that it does not move itself are at rest.
std::vector<Vec3> placesOf(const SkinResponse& response, const TriangleMesh& mesh, const SkinRig& rig) {
    std::vector<Vec3> all = mesh.vertices;
    const auto positions = response.positions();
    for (std::size_t k = 0; k < positions.size(); ++k) all[response.vertices()[k]] = positions[k];
    std::vector<Vec3> places;
    for (const std::uint32_t v : rig.vertices) places.push_back(all[v]);
    return places;
}

/// The skin at every step when the solver may go on until nothing moves.
std::vector<std::vector<Vec3>> convergedSteps(const SceneModel& scene, const SkinModel& skin,
                                              const Muscles& muscles, const std::vector<Activations>& asked) {
    SkinParameters parameters = skinParameters(scene, skin);
    parameters.iterations = 2000;
    SkinResponse response(makeSkinRig(scene.bodies[skin.body].mesh, muscles, *skin.table, parameters));
    std::vector<std::vector<Vec3>> steps;
    for (const Activations& activations : asked) {
        response.update(activations);
        steps.emplace_back(response.positions().begin(), response.positions().end());
    }
    return steps;
}

/// A skin in motion: what each step asks, and the truth about it.
struct Played {
    const TriangleMesh& mesh;
    const SkinRig& rig;
    const std::vector<Activations>& asked;
    std::vector<double> rest; ///< #touched: depths at rest
    std::vector<Truth> truths;
    std::vector<std::vector<Vec3>> converged;
    double restArea = 0;
};

/// What a step asks, and what would be left at it untouched and converged.
void studyStep(SkinMotionStudy& study, const Played& played, const Muscles& muscles, std::size_t s) {
    const Activations& asked = played.asked[s];
    double mean = 0;
    for (const double a : asked) mean += a / static_cast<double>(asked.size());
    study.perStepAsked.push_back(mean);
    const Truth& truth = played.truths[s];
    study.perStepUntouched.push_back(deepestBeyond(truth.depths(played.rig.rest), played.rest));
    study.untouched = std::max(study.untouched, study.perStepUntouched.back());
    const std::vector<Vec3>& converged = played.converged[s];
    study.converged = std::max(study.converged, deepestBeyond(truth.depths(converged), played.rest));
    for (std::size_t v = 0; v < study.touched; ++v)
        study.farthestMove = std::max(study.farthestMove, (converged[v] - played.rig.rest[v]).norm());
    for (std::size_t m = 0; m < muscles.size(); ++m) {
        if (muscles[m]->rigid()) continue;
        const auto& triangles = muscles[m]->muscle().surface.triangles;
        const double volume = enclosedVolume(muscles[m]->vertices(asked[m]), triangles);
        study.muscleVolume = std::max(study.muscleVolume, std::abs(volume / muscles[m]->restVolume() - 1));
    }
}

/// The whole motion with one setting of the solver.
SkinAnswer answerOf(const Played& played, std::shared_ptr<const SkinRig> rig, std::vector<double>& perStep) {
    SkinAnswer answer;
    SkinResponse response(std::move(rig));
    std::vector<double> times;
    double squares = 0;
    const double steps = static_cast<double>(played.asked.size());
    for (std::size_t s = 0; s < played.asked.size(); ++s) {
        const double before = threadSeconds();
        const bool moved = response.update(played.asked[s]).moved;
        if (moved) times.push_back(1e9 * (threadSeconds() - before));
        const std::vector<Vec3> positions = placesOf(response, played.mesh, played.rig);
        perStep.push_back(deepestBeyond(played.truths[s].depths(positions), played.rest));
        answer.deepest = std::max(answer.deepest, perStep.back());
        answer.meanDepth += perStep.back() / steps;
        for (std::size_t v = 0; v < positions.size(); ++v) {
            const double away = (positions[v] - played.converged[s][v]).norm();
            answer.farthest = std::max(answer.farthest, away);
            squares += away * away;
        }
        if (played.restArea > 0)
            answer.areaChange = std::max(
                answer.areaChange, std::abs(areaOf(positions, played.rig.triangles) / played.restArea - 1));
    }
    answer.rms = std::sqrt(squares / (steps * static_cast<double>(played.rig.vertices.size())));
    std::ranges::sort(times);
    if (!times.empty()) answer.nanoseconds = times[times.size() / 2];
    return answer;
}

} // namespace

SkinMotionStudy studySkinMotion(const SceneModel& scene, const SkinModel& skin, const Muscles& muscles,
                                bool quick) {
    SkinMotionStudy study;
    const std::vector<Activations> asked = motionOf(scene, skin, muscles, quick ? 37 : 73, study.motion);
    study.steps = asked.size();
    const TriangleMesh& mesh = scene.bodies[skin.body].mesh;
    const auto rigOf = [&](int sweeps) {
        SkinParameters parameters = skinParameters(scene, skin);
        if (sweeps > 0) parameters.iterations = sweeps;
        parameters.faithful = sweeps == 0;
        return makeSkinRig(mesh, muscles, *skin.table, parameters);
    };
    const int usual = skinParameters(scene, skin).iterations;
    const auto rig = rigOf(usual);
    study.touched = rig->vertices.size();
    if (study.touched == 0) return study;
    Played played{mesh,
                  *rig,
                  asked,
                  truthAt(muscles, Activations(muscles.size(), 0.0)).depths(rig->rest),
                  {},
                  convergedSteps(scene, skin, muscles, asked),
                  areaOf(rig->rest, rig->triangles)};
    for (std::size_t s = 0; s < asked.size(); ++s) {
        played.truths.push_back(truthAt(muscles, asked[s]));
        studyStep(study, played, muscles, s);
    }
    std::vector<int> settings{0, 1, 2, 4, 8, 16, 32, 64, 128};
    if (std::ranges::find(settings, usual) == settings.end()) settings.push_back(usual);
    for (const int sweeps : settings) {
        std::vector<double> perStep;
        study.answers.push_back(answerOf(played, rigOf(sweeps), perStep));
        study.answers.back().sweeps = sweeps;
        study.answers.back().usual = sweeps == usual;
        if (sweeps == usual) study.perStepUsual = std::move(perStep);
    }
    return study;
}

} // namespace tss::reporting
