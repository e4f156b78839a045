#pragma once
#include "bake/model/SceneModel.h"

#include <set>

namespace tss {

/// A motion to look at, for a scene without one of its own: one degree of freedom after the other goes from
/// rest to its lower limit, to its upper one and back, two seconds each, in the order of the scene's joints,
/// but for the `others`, which something else moves; then one muscle after the other contracts and lets go.
/// Ends where the last one does.
void addShowMotion(SceneModel& scene, const std::set<std::size_t>& others = {});

} // namespace tss
