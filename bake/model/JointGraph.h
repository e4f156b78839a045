#pragma once
#include "bake/model/SceneModel.h"

#include <optional>

namespace tss {

/// Indices of the joints that lead from one body to another, in this order; empty when none do, nothing when
/// there is more than one way. Joints that are not enabled do not count; the world counts as a body that
/// joints may share.
std::optional<std::vector<int>> findChain(const std::vector<Joint>& joints, int bodyA, int bodyB);

} // namespace tss
