#include "bake/play/FreeMuscles.h"

#include "bake/base/Error.h"
#include "bake/model/UnderSkin.h"
#include "bake/play/MuscleWays.h"
#include "bake/play/SkinSetup.h"

#include <algorithm>

namespace tss {

bool underSomeSkin(const SceneModel& scene, std::size_t muscle) {
    return std::ranges::any_of(scene.skins, [&](const SkinModel& skin) {
        return std::ranges::find(skin.muscles, static_cast<int>(muscle)) != skin.muscles.end();
    });
}

FreeMuscles::FreeMuscles(const SceneModel& scene, std::vector<std::string>& warnings) : scene_(scene) {
    for (std::size_t m = 0; m < scene.muscles.size(); ++m) {
        const MuscleModel& model = scene.muscles[m];
        if (underSomeSkin(scene, m)) continue;
        try {
            auto deformer = std::make_shared<const MuscleDeformer>(muscleOf(scene, model));
            items_.push_back({&model, deformer, MuscleShape(*deformer),
                              model.bone < 0 ? std::vector<int>() : muscleChain(scene, model), 0});
        } catch (const InputError& error) {
            warnings.push_back(model.path + " does not play: " + error.message);
        }
    }
}

void FreeMuscles::activate(double timeCode) {
    for (Item& item : items_) item.activation = item.model->activation.at(timeCode);
}

void FreeMuscles::pose(std::vector<TriangleMesh>& meshes, std::vector<Pose>& placements) const {
    const std::vector<Pose> now = placements;
    for (const Item& item : items_) {
        const MuscleModel& model = *item.model;
        if (!item.deformer->rigid()) {
            const auto bones =
                item.chain.empty() ? ChainMotion() : muscleMotion(scene_, model, item.chain, now);
            meshes[model.body].vertices = item.shape.vertices(item.activation, bones);
        }
        if (model.bone < 0) continue;
        // It goes with its bone, whatever its own prim does.
        const Pose &bone = scene_.bodies[model.bone].placement, &body = scene_.bodies[model.body].placement;
        if (now[model.bone].matrix() != bone.matrix())
            placements[model.body] = now[model.bone] * bone.inverse(Eigen::Isometry) * body;
    }
}

} // namespace tss
