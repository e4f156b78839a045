#pragma once
#include "bake/model/SceneModel.h"

#include <memory>
#include <string>
#include <vector>

namespace tss {
class MuscleDeformer;
}

namespace tss::reporting {

/// In the order of underSkin(): the muscles and bones of a skin.
using Muscles = std::vector<std::shared_ptr<const MuscleDeformer>>;

/// What a step of a skin's motion asks of what is below it.
struct SkinAsked {
    std::vector<double> activations; ///< one each, 0 of a bone
    std::vector<Pose> poses;         ///< motion of each since rest, in the skin's frame; empty: none moves
};

/// The motion that a skin is judged along.
struct SkinAskedMotion {
    std::string inWords;
    std::vector<SkinAsked> steps;
    bool bones = false; ///< some bone moves in it
};

/// The scene's own animation, joints as it asks for them. Where nothing below the skin moves in that, all
/// activations from their lower end to their upper one and back; of a skin on bones alone, each joint value
/// from one limit to the other in turn.
SkinAskedMotion skinAskedMotion(const SceneModel& scene, const SkinModel& skin, const Muscles& muscles,
                                int steps);

/// Whether an activation changes its shape.
bool contracts(const MuscleDeformer& muscle);
bool anyContracts(const Muscles& muscles);

/// The mean activation of those that can contract; 0 where none can.
double meanActivation(const Muscles& muscles, const std::vector<double>& activations);

} // namespace tss::reporting
