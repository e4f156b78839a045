#pragma once
#include "bake/base/Progress.h"
#include "bake/motion/Motion.h"
#include "bake/search/CandidatePairs.h"

#include <cstdint>

namespace tss {

/// The DOF values that a sampled search looks at (METHOD 2.1): about half of them on a grid that includes the
/// limits, or at some of Q's corners where these alone are more, the rest along random lines through Q, 16 a
/// line with both ends. Values outside the limit planes are left out. The same seed gives the same list.
std::vector<std::vector<double>> exploredPoses(const Motion& motion, std::size_t samples, std::uint64_t seed);

struct SampledSearchOptions {
    std::size_t samples = 4096; ///< poses to look at, over all DOFs; see exploredPoses()
    std::uint64_t seed = 1;
    ContactRule rule; ///< of these spheres
};

/// Tc as the paper finds it: every sphere pair that collides at one of the explored poses (METHOD 2.1). What
/// lies between the poses is not seen. Stopped early by progress, it has what was found by then.
CandidatePairs searchSampled(const SphereSet& a, const SphereSet& b, const Motion& motion,
                             const SampledSearchOptions& options = {}, const Progress& progress = {});

} // namespace tss
