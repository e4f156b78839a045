#pragma once
#include "bake/motion/Motion.h"

#include <cstdint>

namespace tss {

/// DOF values uniformly over the limits, from a seed; those outside the limit planes are drawn again. May
/// give fewer where the planes leave next to nothing.
std::vector<std::vector<double>> randomPoses(const Motion& motion, std::size_t count, std::uint64_t seed);

} // namespace tss
