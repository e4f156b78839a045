#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <vector>

namespace tss {

/// Muscle::insertionShares of a muscle between two bones, all in one frame, at rest: what lies on a bone
/// moves with it, as skin does (METHOD 6.1, 6.5). Empty, for the fibre to tell, where a bone has no mesh.
std::vector<double> insertionShares(const TriangleMesh& surface, const TriangleMesh& origin,
                                    const TriangleMesh& insertion);

} // namespace tss
