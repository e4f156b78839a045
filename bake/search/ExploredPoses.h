#pragma once
#include "bake/motion/Motion.h"

#include <cstdint>

namespace tss {

/// The DOF values that a sampled search looks at (METHOD 2.1): about half of them on a grid that includes the
/// limits, the rest along random lines through Q, 16 a line with both ends. Values outside the limit planes
/// are left out. The same seed gives the same list.
std::vector<std::vector<double>> exploredPoses(const Motion& motion, std::size_t samples, std::uint64_t seed);

} // namespace tss
