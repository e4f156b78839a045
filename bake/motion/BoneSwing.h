#pragma once
#include "bake/motion/Motion.h"

#include <vector>

namespace tss {

/// The motion of all bodies under a skin while one joint value goes from rest to a limit, sampled: #samples
/// of #bodies poses, each the motion since rest of the bone that the body moves with, in the skin's frame.
using BoneSwing = std::vector<std::vector<Pose>>;

} // namespace tss
