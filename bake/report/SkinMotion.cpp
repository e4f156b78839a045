#include "bake/report/SkinMotion.h"

#include "bake/base/Order.h"
#include "bake/compare/PushedSkin.h"
#include "bake/geometry/PartSet.h"
#include "bake/model/Kinematics.h"
#include "bake/model/UnderSkin.h"
#include "bake/motion/MuscleDeformer.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/play/BelowSkin.h"
#include "bake/play/SkinSetup.h"
#include "bake/report/Timing.h"
#include "bake/respond/SkinResponse.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace tss::reporting {

namespace {

/// values: of all joints, in file order.
SkinAsked askedAt(const SceneModel& scene, const SkinModel& skin, std::vector<double> activations,
                  const std::vector<double>& values) {
    SkinAsked asked{std::move(activations), skinPoses(scene, skin, posedBodies(scene, values))};
    if (std::ranges::all_of(asked.poses, isIdentity)) asked.poses.clear();
    return asked;
}

std::vector<SkinAsked> ownMotion(const SceneModel& scene, const SkinModel& skin, int steps) {
    std::vector<SkinAsked> asked;
    if (!(scene.endTimeCode > scene.startTimeCode)) return asked;
    for (int s = 0; s < steps; ++s) {
        const double time = scene.startTimeCode + (scene.endTimeCode - scene.startTimeCode) * s / (steps - 1);
        asked.push_back(askedAt(scene, skin, skinActivations(scene, skin, time), drivenValues(scene, time)));
    }
    const bool still = std::ranges::all_of(
        asked, [&](const SkinAsked& a) { return a.activations == asked[0].activations && a.poses.empty(); });
    return still ? std::vector<SkinAsked>{} : asked;
}

std::vector<SkinAsked> activationsUpAndDown(const Muscles& muscles, int steps) {
    std::vector<SkinAsked> asked;
    for (int s = 0; s < steps; ++s) {
        SkinAsked step;
        for (const auto& muscle : muscles) {
            const double low = std::max(0.0, muscle->muscle().activationLower),
                         high = muscle->muscle().activationUpper;
            step.activations.push_back(low + (1 - std::abs(1 - 2.0 * s / (steps - 1))) * (high - low));
        }
        asked.push_back(std::move(step));
    }
    return asked;
}

std::vector<SkinAsked> jointsInTurn(const SceneModel& scene, const SkinModel& skin, const Muscles& muscles,
                                    int steps) {
    std::vector<SkinAsked> asked;
    const std::vector<double> rest = restValues(scene);
    const int each = std::max(2, steps / std::max(1, static_cast<int>(rest.size())));
    std::size_t next = 0;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) {
            const auto [lower, upper] = swingEnds(dof);
            for (int s = 0; s < each; ++s) {
                std::vector<double> values = rest;
                values[next] = lower + (upper - lower) * s / (each - 1);
                asked.push_back(askedAt(scene, skin, std::vector<double>(muscles.size(), 0.0), values));
            }
            ++next;
        }
    return asked;
}

/// How much deeper than at rest the deepest is.
double deepestBeyond(const std::vector<double>& now, const std::vector<double>& rest) {
    double deepest = 0;
    for (std::size_t i = 0; i < now.size(); ++i) deepest = std::max(deepest, now[i] - rest[i]);
    return deepest;
}

/// The places of the vertices that a rig moves. all: those of all vertices of its skin.
std::vector<Vec3> placesOf(const std::vector<Vec3>& all, const SkinRig& rig) {
    std::vector<Vec3> places;
    for (const std::uint32_t v : rig.vertices) places.push_back(all[v]);
    return places;
}

/// Where a response has the vertices of another's rig: those that it does not move itself are at rest.
std::vector<Vec3> placesOf(const SkinResponse& response, const TriangleMesh& mesh, const SkinRig& rig) {
    std::vector<Vec3> all = mesh.vertices;
    const auto positions = response.positions();
    for (std::size_t k = 0; k < positions.size(); ++k) all[response.vertices()[k]] = positions[k];
    return placesOf(all, rig);
}

/// Where a response has the skin at every step.
std::vector<std::vector<Vec3>> stepsOf(std::shared_ptr<const SkinRig> rig,
                                       const std::vector<SkinAsked>& asked, const TriangleMesh& mesh,
                                       const SkinRig& places) {
    SkinResponse response(std::move(rig));
    std::vector<std::vector<Vec3>> steps;
    for (const SkinAsked& step : asked) {
        response.update(step.activations, step.poses);
        steps.push_back(placesOf(response, mesh, places));
    }
    return steps;
}

/// A skin in motion: what each step asks, and the truth about it.
struct Played {
    const TriangleMesh& mesh;
    const SkinRig& rig;
    const std::vector<SkinAsked>& asked;
    std::vector<double> rest; ///< #touched: depths at rest
    std::vector<ShapesBelow> truths;
    std::vector<std::vector<Vec3>> converged; ///< by a solver that may go on until nothing moves
    std::vector<std::vector<Vec3>> untouched; ///< where nothing pushes
    double restArea = 0;
};

/// What a step asks, and what would be left at it untouched and converged.
void studyStep(SkinMotionStudy& study, const Played& played, const BelowSkin& below, std::size_t s) {
    const SkinAsked& asked = played.asked[s];
    study.perStepAsked.push_back(meanActivation(below.muscles(), asked.activations));
    const ShapesBelow& truth = played.truths[s];
    study.perStepUntouched.push_back(deepestBeyond(truth.depths(played.untouched[s]), played.rest));
    study.untouched = std::max(study.untouched, study.perStepUntouched.back());
    const std::vector<Vec3>& converged = played.converged[s];
    study.converged = std::max(study.converged, deepestBeyond(truth.depths(converged), played.rest));
    for (std::size_t v = 0; v < study.touched; ++v)
        study.farthestMove = std::max(study.farthestMove, (converged[v] - played.rig.rest[v]).norm());
    for (std::size_t m = 0; m < below.muscles().size(); ++m) {
        const MuscleDeformer& muscle = *below.muscles()[m];
        if (muscle.rigid()) continue;
        const double volume =
            enclosedVolume(below.vertices(m, asked.activations, asked.poses), muscle.closedTriangles());
        study.muscleVolume = std::max(study.muscleVolume, std::abs(volume / muscle.restVolume() - 1));
    }
}

/// The whole motion by one way of answering. update: asks for a step, and says whether that is anew; places:
/// where the rig's vertices are then.
SkinAnswer answerOf(const Played& played, const std::function<bool(const SkinAsked&)>& update,
                    const std::function<std::vector<Vec3>()>& places, std::vector<double>& perStep) {
    SkinAnswer answer;
    std::vector<double> times;
    double squares = 0;
    const double steps = static_cast<double>(played.asked.size());
    for (std::size_t s = 0; s < played.asked.size(); ++s) {
        const double before = threadSeconds();
        if (update(played.asked[s])) times.push_back(1e9 * (threadSeconds() - before));
        const std::vector<Vec3> positions = places();
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
                answer.areaChange, std::abs(area({positions, played.rig.triangles}) / played.restArea - 1));
    }
    answer.rms = std::sqrt(squares / (steps * static_cast<double>(played.rig.vertices.size())));
    if (!times.empty()) answer.nanoseconds = median(std::move(times));
    return answer;
}

SkinAnswer answerOf(const Played& played, std::shared_ptr<const SkinRig> rig, std::vector<double>& perStep) {
    SkinResponse response(std::move(rig));
    return answerOf(
        played, [&](const SkinAsked& asked) { return response.update(asked.activations, asked.poses).moved; },
        [&] { return placesOf(response, played.mesh, played.rig); }, perStep);
}

/// The paper's way.
SkinAnswer answerOf(const Played& played, compare::PushedSkin skin, std::vector<double>& perStep) {
    return answerOf(
        played, [&](const SkinAsked& asked) { return skin.update(asked.activations, asked.poses); },
        [&] { return placesOf(skin.places(), played.rig); }, perStep);
}

} // namespace

bool contracts(const MuscleDeformer& muscle) {
    return muscle.muscle().maxContraction > 0 && !muscle.rigid();
}

bool anyContracts(const Muscles& muscles) {
    return std::ranges::any_of(muscles, [](const auto& muscle) { return contracts(*muscle); });
}

SkinAskedMotion skinAskedMotion(const SceneModel& scene, const SkinModel& skin, const Muscles& muscles,
                                int steps) {
    SkinAskedMotion motion{"the scene's own animation", ownMotion(scene, skin, steps)};
    if (motion.steps.empty() && anyContracts(muscles))
        motion = {"all activations up and down again", activationsUpAndDown(muscles, steps)};
    else if (motion.steps.empty())
        motion = {"each joint value from one limit to the other in turn",
                  jointsInTurn(scene, skin, muscles, steps)};
    motion.bones = std::ranges::any_of(motion.steps, [](const SkinAsked& a) { return !a.poses.empty(); });
    return motion;
}

double meanActivation(const Muscles& muscles, const std::vector<double>& activations) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t m = 0; m < muscles.size(); ++m) {
        if (!contracts(*muscles[m])) continue;
        sum += activations[m];
        ++count;
    }
    return count ? sum / static_cast<double>(count) : 0;
}

SkinMotionStudy studySkinMotion(const SceneModel& scene, const SkinModel& skin, const Muscles& muscles,
                                bool quick) {
    SkinMotionStudy study;
    const SkinAskedMotion motion = skinAskedMotion(scene, skin, muscles, quick ? 37 : 73);
    const std::vector<SkinAsked>& asked = motion.steps;
    study.motion = motion.inWords;
    study.bones = motion.bones;
    study.steps = asked.size();
    const TriangleMesh& mesh = scene.bodies[skin.body].mesh;
    const SkinParameters parameters = skinParameters(scene, skin);
    const auto rigOf = [&](int sweeps) {
        SkinParameters changed = parameters;
        changed.iterations = sweeps;
        return makeSkinRig(mesh, muscles, *skin.table, changed);
    };
    const int usual = parameters.iterations;
    const auto rig = rigOf(usual);
    study.touched = rig->vertices.size();
    if (study.touched == 0) return study;
    const BelowSkin below(muscles, underSkin(scene, skin));
    const std::vector<double> resting(muscles.size(), 0.0);
    SkinModel carried = skin;
    carried.table = nullptr;
    Played played{mesh,
                  *rig,
                  asked,
                  below.at(resting, {}).depths(rig->rest),
                  {},
                  stepsOf(rigOf(2000), asked, mesh, *rig),
                  motion.bones ? stepsOf(skinRig(scene, carried), asked, mesh, *rig)
                               : std::vector<std::vector<Vec3>>(asked.size(), rig->rest),
                  area({rig->rest, rig->triangles})};
    for (std::size_t s = 0; s < asked.size(); ++s) {
        played.truths.push_back(below.at(asked[s].activations, asked[s].poses));
        studyStep(study, played, below, s);
    }
    std::vector<int> settings{0, 1, 2, 4, 8, 16, 32, 64, 128};
    if (std::ranges::find(settings, usual) == settings.end()) settings.push_back(usual);
    for (const int sweeps : settings) {
        std::vector<double> perStep;
        study.answers.push_back(
            sweeps > 0 ? answerOf(played, rigOf(sweeps), perStep)
                       : answerOf(played, compare::PushedSkin(mesh, *skin.table, muscles, parameters.chains),
                                  perStep));
        study.answers.back().sweeps = sweeps;
        study.answers.back().usual = sweeps == usual;
        if (sweeps == usual) study.perStepUsual = std::move(perStep);
    }
    return study;
}

} // namespace tss::reporting
