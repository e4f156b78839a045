#include "bake/pipeline/MuscleNotes.h"

#include "bake/motion/MuscleSpan.h"
#include "bake/motion/MuscleVolume.h"
#include "bake/play/MuscleWays.h"

#include <cmath>
#include <fmt/format.h>

namespace tss {
namespace {

constexpr double worthSaying = 0.01; ///< of the volume

/// By how much of its volume a muscle is off at worst where its bones come to, at rest and fully active.
double worstVolume(const MuscleDeformer& muscle, const std::vector<DualPose>& far, const Pose& toSkin) {
    const MuscleSpan span(muscle);
    const std::vector<Tri>& triangles = muscle.muscle().surface.triangles;
    double worst = 0;
    for (const double activation : {muscle.muscle().activationLower, muscle.muscle().activationUpper}) {
        const std::vector<Vec3> rest = muscle.vertices(activation);
        for (const DualPose& motion : far) {
            PoseBlend blend(true);
            blend.add(1, motion);
            std::vector<Vec3> places = rest;
            span.carry(toSkin * blend.pose() * toSkin.inverse(Eigen::Isometry), places);
            const double off = enclosedVolume(places, triangles) / muscle.restVolume() - 1;
            if (std::abs(off) > std::abs(worst)) worst = off;
        }
    }
    return worst;
}

} // namespace

std::vector<std::string> muscleNotes(const SceneModel& scene, const SkinModel& skin,
                                     const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles) {
    std::vector<std::string> notes;
    const std::vector<UnderSkin> under = underSkin(scene, skin);
    for (std::size_t m = 0; m < under.size(); ++m) {
        if (under[m].muscle < 0 || under[m].insertion < 0 || under[m].bone < 0) continue;
        const MuscleModel& model = scene.muscles[under[m].muscle];
        const MuscleWays ways = muscleWays(scene, model);
        if (ways.unclear)
            notes.push_back(model.path + " is turned by more than half a turn either way, or nearly all the "
                                         "way round, by the joints between its bones: there it jumps from "
                                         "one way round to the other");
        const Pose toSkin =
            scene.bodies[skin.body].placement.inverse(Eigen::Isometry) * scene.bodies[model.body].placement;
        if (const double worst = worstVolume(*muscles[m], ways.far, toSkin); std::abs(worst) > worthSaying)
            notes.push_back(fmt::format("{} cannot keep its volume within the limits of the joints between "
                                        "its bones: {:+.0f} % where they draw it together or apart the most",
                                        model.path, 100 * worst));
    }
    return notes;
}

} // namespace tss
