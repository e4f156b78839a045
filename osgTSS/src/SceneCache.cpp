#include "SceneCache.h"

#include "bake/SkinSetup.h"

#include <osg/Notify>

namespace osgTSS {

std::shared_ptr<const tss::JointPlan> Scene::Cache::plan(const std::vector<std::string>& pairPaths) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<const tss::JointPlan>& plan = plans[pairPaths];
    if (plan) return plan;
    std::vector<std::string> warnings;
    plan = tss::makeJointPlan(*model, pairPaths, &warnings);
    for (const std::string& warning : warnings) OSG_WARN << "osgTSS: " << warning << std::endl;
    return plan;
}

std::shared_ptr<const tss::MuscleDeformer> Scene::Cache::muscle(int index) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<const tss::MuscleDeformer>& muscle = muscles[index];
    if (!muscle) muscle = std::make_shared<const tss::MuscleDeformer>(model->muscles[index].muscle);
    return muscle;
}

std::shared_ptr<const tss::SkinRig> Scene::Cache::rig(int index) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<const tss::SkinRig>& rig = rigs[index];
    const tss::SkinModel& skin = model->skins[index];
    if (!rig && skin.table) rig = tss::skinRig(*model, skin);
    return rig;
}

} // namespace osgTSS
