#pragma once
#include "bake/robot/Robot.h"

namespace tss {

/// The closed mesh of a shape that is no mesh, in its own frame, outward. Round ones enclose the shape: what
/// is proven of the mesh holds for the shape; they stand out of it by at most half a percent of its radius.
/// Throws InputError for lengths that are not above 0 (a capsule's may be 0).
TriangleMesh meshOf(const RobotShape& shape);

} // namespace tss
