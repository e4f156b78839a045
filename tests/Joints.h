#pragma once
#include "bake/motion/Motion.h"

#include <algorithm>

/// DOFs by hand. Rest at 0, or at the limit nearest to it.
namespace joints {

/// origin: a point of the axis, scene units; axis: any length; limits in radians.
inline tss::Dof turn(const tss::Vec3& origin, const tss::Vec3& axis, double lower, double upper) {
    tss::Dof dof;
    dof.name = "turn";
    dof.origin = origin;
    dof.axis = axis.normalized();
    dof.lower = lower;
    dof.upper = upper;
    dof.rest = std::clamp(0.0, lower, upper);
    return dof;
}

/// axis: the way of a unit of the value, not always of unit length; limits in such units.
inline tss::Dof slide(const tss::Vec3& axis, double lower, double upper) {
    tss::Dof dof;
    dof.name = "slide";
    dof.kind = tss::DofKind::Translation;
    dof.axis = axis;
    dof.lower = lower;
    dof.upper = upper;
    dof.rest = std::clamp(0.0, lower, upper);
    return dof;
}

} // namespace joints
