#include "SceneCache.h"

namespace osgTSS {

tss::Muscle inFrame(const tss::Muscle& muscle, const tss::Pose& toFrame) {
    tss::Muscle seen = muscle;
    for (tss::Vec3& vertex : seen.surface.vertices) vertex = toFrame * vertex;
    for (tss::Vec3& point : seen.fibre) point = toFrame * point;
    return seen;
}

std::shared_ptr<const JointPlan> Scene::Cache::plan(const std::vector<std::string>& pairPaths) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<const JointPlan>& plan = plans[pairPaths];
    if (!plan) plan = makeJointPlan(*model, pairPaths);
    return plan;
}

std::shared_ptr<const tss::MuscleDeformer> Scene::Cache::muscleLocked(int index) {
    std::shared_ptr<const tss::MuscleDeformer>& muscle = muscles[index];
    if (!muscle) muscle = std::make_shared<const tss::MuscleDeformer>(model->muscles[index].muscle);
    return muscle;
}

std::shared_ptr<const tss::MuscleDeformer> Scene::Cache::muscle(int index) {
    const std::lock_guard lock(mutex);
    return muscleLocked(index);
}

std::shared_ptr<const tss::SkinRig> Scene::Cache::rig(int index) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<const tss::SkinRig>& rig = rigs[index];
    const tss::SkinModel& skin = model->skins[index];
    if (rig || !skin.table) return rig;
    const tss::Pose world = model->bodies[skin.body].placement.inverse(Eigen::Isometry);
    std::vector<std::shared_ptr<const tss::MuscleDeformer>> seen;
    for (int m : skin.muscles) {
        const tss::MuscleModel& muscle = model->muscles[m];
        const tss::Pose toSkin = world * model->bodies[muscle.body].placement;
        seen.push_back(toSkin.isApprox(tss::Pose::Identity(), 0)
                           ? muscleLocked(m)
                           : std::make_shared<const tss::MuscleDeformer>(inFrame(muscle.muscle, toSkin)));
    }
    tss::SkinParameters parameters;
    parameters.stretchCompliance = skin.stretchCompliance;
    parameters.bendCompliance = skin.bendCompliance;
    parameters.tether = skin.tether;
    parameters.attach = skin.attach;
    rig = tss::makeSkinRig(model->bodies[skin.body].mesh, seen, *skin.table, parameters);
    return rig;
}

} // namespace osgTSS
