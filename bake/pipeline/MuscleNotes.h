#pragma once
#include "bake/model/SceneModel.h"

#include <memory>
#include <string>
#include <vector>

namespace tss {

class MuscleDeformer;

/// What is to be said of the muscles between two bones that lie under a skin: those that cannot keep their
/// volume everywhere within the joints' limits, and those that joints turn so far that two ways round are
/// meant. muscles: of underSkin(), in the skin's frame.
std::vector<std::string> muscleNotes(const SceneModel& scene, const SkinModel& skin,
                                     const std::vector<std::shared_ptr<const MuscleDeformer>>& muscles);

} // namespace tss
