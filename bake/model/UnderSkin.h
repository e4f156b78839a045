#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// Something below a skin, or something that only moves it.
struct UnderSkin {
    int muscle = -1;        ///< index into muscles; -1: a bone
    int body = -1;          ///< whose surface it has; -1: none, a body that the skin's own weights name
    int bone = -1;          ///< the body that it moves with; -1: with the skin
    std::vector<int> chain; ///< of a muscle over several bones: which of what is below the skin move with
                            ///< those behind the first
};

/// What is below a skin, in the order that its table knows: its muscles, then its bones; then the other
/// bodies that its own weights name, and those that its muscles run over.
std::vector<UnderSkin> underSkin(const SceneModel& scene, const SkinModel& skin);
/// The muscle's prim, or the bone's.
const std::string& pathOf(const SceneModel& scene, const UnderSkin& under);

/// The bones that a muscle runs over behind that of its origin, in order, as bodies: those that the joints
/// from its origin's to its insertion's pass, as far as they move by themselves and have a mesh, then that of
/// its insertion. Of a muscle on one bone, none.
std::vector<int> muscleChain(const SceneModel& scene, const MuscleModel& muscle);

} // namespace tss
