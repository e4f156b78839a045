#pragma once
#include "bake/robot/RobotScene.h"

namespace tss::tool {

/// Of the pairs of a character, a scene with skins, those that its animation asks for. Not two bones that it
/// has in each other half of the time or more: they would hold it all along, for what is cut out of one mesh
/// lies in each other where it bends. With `near`, not those either that it never has near each other (see
/// MotionContact). Both with a note. What cannot be a pair is left in `unmade` by the same rules.
void keepPairsOfAnimation(RobotScene& made, bool near);

} // namespace tss::tool
