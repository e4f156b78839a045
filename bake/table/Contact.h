#pragma once
#include "bake/motion/Motion.h"

namespace tss {

/// Everything about the nearest test at a pose, in double from T(q) itself. Lengths in scene units. Of an
/// empty table gap is infinity, test -1, and nothing else means anything.
struct TableContact {
    double gap = 0;
    int test = -1;
    Vec3 point = Vec3::Zero();  ///< A's frame, half way between the two sphere surfaces
    Vec3 normal = Vec3::Zero(); ///< unit, A's frame, from A towards B
    DofValues gradient{};       ///< d gap / d q, one per DOF
};

} // namespace tss
