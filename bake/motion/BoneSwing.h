#pragma once
#include "bake/motion/Motion.h"

#include <vector>

namespace tss {

/// What the bones under a skin do while one joint value goes from rest to a limit: #stations, near to each
/// other, of #muscles poses, the motion of the bone that each rides on since rest, in the skin's frame.
using BoneSwing = std::vector<std::vector<Pose>>;

} // namespace tss
