#pragma once
#include "bake/base/Degrees.h"
#include "bake/motion/Motion.h"

namespace tss {

/// Values of a DOF as people and files write them: degrees for rotations, else as they are.
inline double toUser(const Dof& dof, double q) {
    return dof.kind == DofKind::Rotation ? toDegrees(q) : q;
}
inline double fromUser(const Dof& dof, double value) {
    return dof.kind == DofKind::Rotation ? toRadians(value) : value;
}

} // namespace tss
