#include "bake/SkinSetup.h"

#include "bake/base/Error.h"
#include "bake/model/Kinematics.h"

#include <algorithm>
#include <cmath>

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

constexpr int stations = 16; ///< of a swing, after rest

/// What the bones under a skin do while one joint value at a time goes to either limit.
std::vector<BoneSwing> swingsOf(const SceneModel& scene, const SkinModel& skin) {
    std::vector<double> values;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) values.push_back(dof.rest);
    const std::vector<double> rest = values;
    std::vector<BoneSwing> swings;
    std::size_t next = 0;
    for (const Joint& joint : scene.joints)
        for (const Dof& dof : joint.dofs) {
            for (const double limit : {dof.lower, dof.upper}) {
                if (!std::isfinite(limit) || limit == dof.rest) continue;
                BoneSwing swing;
                bool moves = false;
                for (int s = 1; s <= stations; ++s) {
                    values[next] = s == stations ? limit : dof.rest + (limit - dof.rest) * s / stations;
                    swing.push_back(skinPoses(scene, skin, posedBodies(scene, values)));
                    for (const Pose& pose : swing.back())
                        moves = moves || pose.matrix() != Pose::Identity().matrix();
                }
                values = rest;
                if (moves) swings.push_back(std::move(swing));
            }
            ++next;
        }
    return swings;
}

/// What each body under a skin moves with: one frame a bone.
std::vector<int> framesOf(const SceneModel& scene, const SkinModel& skin) {
    std::vector<int> bones, frames;
    for (const int index : skin.muscles) {
        const int bone = scene.muscles.at(static_cast<std::size_t>(index)).bone;
        const auto known = std::find(bones.begin(), bones.end(), bone);
        frames.push_back(bone < 0 ? -1 : static_cast<int>(known - bones.begin()));
        if (bone >= 0 && known == bones.end()) bones.push_back(bone);
    }
    return frames;
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
    parameters.selfContact = skin.selfContact;
    parameters.frames = framesOf(scene, skin);
    parameters.swings = swingsOf(scene, skin);
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
