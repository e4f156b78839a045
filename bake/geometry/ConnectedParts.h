#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <vector>

namespace tss {

/// The mesh of each connected part of a surface, vertices and triangles in their order; what stands at the
/// same place is connected.
std::vector<TriangleMesh> connectedParts(const TriangleMesh& soup);

} // namespace tss
