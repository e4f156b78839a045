#pragma once
#include "bake/verify/KernelErrors.h"

#include <string>

namespace tss::verify {

/// Proves of the clusters of a prepared table that none is passed over that has a test to be asked: each of
/// its tests is within the pair of spheres that bounds it, by the triangle inequality at any pose, and what
/// the kernel rounds about that pair does not hide that it is near. Returns what does not hold; empty:
/// proven. posed: how far a point may come out of the pose that the kernel is given.
std::string refuteClusters(const PreparedTable& prepared, const std::vector<Exact>& tests, double posed);

} // namespace tss::verify
