#pragma once
#include "bake/robot/Robot.h"
#include "bake/usd/Stage.h"

namespace tss {

/// What a stage of UsdPhysics describes: rigid bodies as links, each with all gprims below it, those that
/// collide and those that are only seen; joints with their limits and drives; pairs that are filtered.
/// Colliders of no rigid body are one link, "world", and so is each prim that a joint ties a body to. Where
/// nothing is rigid and nothing collides, each gprim is a link of its own. Joints form a forest: of those
/// that would close a loop, the ones that say excludeFromArticulation first, the last are left out, which
/// only adds poses. Turns without limits, or with limits of a turn or more, are one whole turn; slides
/// without limits tie nothing. What is left out or taken otherwise is noted by name. Throws InputError with
/// the path.
Robot robotOf(UsdStage stage, const std::string& file);

} // namespace tss
