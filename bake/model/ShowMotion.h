#pragma once
#include "bake/model/SceneModel.h"

namespace tss {

/// A motion to look at, for a scene without one of its own: one degree of freedom after the other goes from
/// rest to its lower limit, to its upper one and back, two seconds each, in the order of the scene's joints;
/// then one muscle after the other contracts and lets go. Ends where the last one does.
void addShowMotion(SceneModel& scene);

} // namespace tss
