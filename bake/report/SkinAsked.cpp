#include "bake/report/SkinAsked.h"

#include "bake/model/Kinematics.h"
#include "bake/motion/MuscleDeformer.h"
#include "bake/play/SkinSetup.h"

#include <algorithm>
#include <cmath>

namespace tss::reporting {

namespace {

bool moves(const Pose& pose) {
    return pose.matrix() != Pose::Identity().matrix();
}

/// values: of all joints, in file order.
SkinAsked askedAt(const SceneModel& scene, const SkinModel& skin, std::vector<double> activations,
                  const std::vector<double>& values) {
    SkinAsked asked{std::move(activations), skinPoses(scene, skin, posedBodies(scene, values))};
    if (std::ranges::none_of(asked.poses, moves)) asked.poses.clear();
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

} // namespace tss::reporting
