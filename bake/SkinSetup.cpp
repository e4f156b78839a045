#include "bake/SkinSetup.h"

#include "bake/base/Error.h"
#include "bake/scene/Kinematics.h"

#include <cmath>
#include <utility>

namespace tss {
namespace {

/// Frame of a muscle's surface to that of the skin, as modelled.
Pose toSkin(const SceneModel& scene, const SkinModel& skin, const MuscleModel& muscle) {
    const Pose toWorld = muscle.body >= 0 ? scene.bodies[muscle.body].placement : Pose::Identity();
    return scene.bodies[skin.body].placement.inverse() * toWorld;
}

const TriangleMesh& meshOf(const SceneModel& scene, const SkinModel& skin) {
    if (skin.body < 0 || skin.body >= static_cast<int>(scene.bodies.size()))
        throw InputError(Where{"", "", skin.path}, "the skin has no mesh");
    return scene.bodies[skin.body].mesh;
}

/// The motions of the bone that a muscle rides on, with one joint value at a time at either limit.
std::vector<Pose> swingsOf(const SceneModel& scene, const SkinModel& skin, int muscle) {
    std::vector<Pose> swings;
    const int bone = scene.muscles.at(static_cast<std::size_t>(muscle)).bone;
    if (bone < 0) return swings;
    std::vector<double> values;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) values.push_back(dof.rest);
    const auto place = static_cast<std::size_t>(bone), under = static_cast<std::size_t>(skin.body);
    const Pose& skinRest = scene.bodies[under].placement;
    const Pose& boneRest = scene.bodies[place].placement;
    std::size_t next = 0;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) {
            for (const double limit : {dof.lower, dof.upper}) {
                if (!std::isfinite(limit)) continue;
                const double rest = std::exchange(values[next], limit);
                const std::vector<Pose> now = posedBodies(scene, values);
                values[next] = rest;
                if (now[place].matrix() == boneRest.matrix() && now[under].matrix() == skinRest.matrix())
                    continue;
                swings.push_back(now[under].inverse() * now[place] * boneRest.inverse() * skinRest);
            }
            ++next;
        }
    return swings;
}

} // namespace

std::vector<std::shared_ptr<const MuscleDeformer>> skinMuscles(const SceneModel& scene,
                                                               const SkinModel& skin) {
    meshOf(scene, skin);
    std::vector<std::shared_ptr<const MuscleDeformer>> result;
    for (const int index : skin.muscles) {
        const MuscleModel& model = scene.muscles.at(static_cast<std::size_t>(index));
        Muscle muscle = model.muscle;
        const Pose pose = toSkin(scene, skin, model);
        // A muscle modelled in the skin's own frame keeps its bits.
        if (pose.matrix() != Pose::Identity().matrix()) {
            for (Vec3& v : muscle.surface.vertices) v = pose * v;
            for (Vec3& v : muscle.fibre) v = pose * v;
        }
        try {
            result.push_back(std::make_shared<const MuscleDeformer>(std::move(muscle)));
        } catch (const InputError& error) {
            throw InputError(Where{error.where.file, error.where.pointer, model.path}, error.message);
        }
    }
    return result;
}

SkinParameters skinParameters(const SceneModel& scene, const SkinModel& skin) {
    meshOf(scene, skin);
    SkinParameters parameters;
    parameters.stretchCompliance = skin.stretchCompliance;
    parameters.bendCompliance = skin.bendCompliance;
    for (const int index : skin.muscles) parameters.swings.push_back(swingsOf(scene, skin, index));
    parameters.tether = skin.tether;
    parameters.attach = skin.attach;
    return parameters;
}

std::shared_ptr<const SkinRig> skinRig(const SceneModel& scene, const SkinModel& skin) {
    if (!skin.table)
        throw InputError(Where{"", "", skin.path}, "the skin has no table: bake the scene first");
    try {
        return makeSkinRig(meshOf(scene, skin), skinMuscles(scene, skin), *skin.table,
                           skinParameters(scene, skin));
    } catch (const InputError& error) {
        if (!error.where.path.empty()) throw;
        throw InputError(Where{"", "", skin.path}, error.message);
    }
}

std::vector<double> skinActivations(const SceneModel& scene, const SkinModel& skin, double timeCode) {
    std::vector<double> activations;
    for (const int index : skin.muscles)
        activations.push_back(scene.muscles.at(static_cast<std::size_t>(index)).activation.at(timeCode));
    return activations;
}

std::vector<Pose> skinPoses(const SceneModel& scene, const SkinModel& skin,
                            std::span<const Pose> placements) {
    std::vector<Pose> poses;
    bool any = false;
    const Pose& skinRest = scene.bodies.at(static_cast<std::size_t>(skin.body)).placement;
    const Pose& skinNow = placements[static_cast<std::size_t>(skin.body)];
    for (const int index : skin.muscles) {
        const int bone = scene.muscles.at(static_cast<std::size_t>(index)).bone;
        poses.push_back(Pose::Identity());
        if (bone < 0) continue;
        any = true;
        const Pose& boneRest = scene.bodies[static_cast<std::size_t>(bone)].placement;
        const Pose& boneNow = placements[static_cast<std::size_t>(bone)];
        const bool still = boneNow.matrix() == boneRest.matrix() && skinNow.matrix() == skinRest.matrix();
        if (!still) poses.back() = skinNow.inverse() * boneNow * boneRest.inverse() * skinRest;
    }
    if (!any) poses.clear();
    return poses;
}

} // namespace tss
