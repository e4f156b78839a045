#include "SceneCache.h"

#include "bake/play/SkinSetup.h"

#include <osg/Notify>

namespace osgTSS {

std::shared_ptr<SharedPlan> Scene::Cache::plan(const std::vector<std::string>& pairPaths) {
    constexpr std::size_t mostRecent = 4; // each holds its tables made ready, megabytes for large ones
    const std::lock_guard lock(mutex);
    if (std::shared_ptr<SharedPlan> plan = plans[pairPaths].lock()) return plan;
    std::vector<std::string> warnings;
    const auto plan = std::make_shared<SharedPlan>(tss::makeJointPlan(*model, pairPaths, &warnings));
    std::erase_if(plans, [](const auto& entry) { return entry.second.expired(); });
    plans[pairPaths] = plan;
    recent.push_back(plan);
    if (recent.size() > mostRecent) recent.pop_front();
    for (const std::string& warning : warnings)
        if (told.insert(warning).second) OSG_WARN << "osgTSS: " << warning << std::endl;
    return plan;
}

std::shared_ptr<const tss::MuscleDeformer> Scene::Cache::muscle(int index) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<const tss::MuscleDeformer>& muscle = muscles[index];
    if (!muscle)
        muscle = std::make_shared<const tss::MuscleDeformer>(tss::muscleOf(*model, model->muscles[index]));
    return muscle;
}

std::shared_ptr<const tss::SkinRig> Scene::Cache::rig(int index) {
    const std::lock_guard lock(mutex);
    std::shared_ptr<const tss::SkinRig>& rig = rigs[index];
    if (!rig) rig = tss::skinRig(*model, model->skins[index]);
    return rig;
}

} // namespace osgTSS
