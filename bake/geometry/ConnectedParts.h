#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <vector>

namespace tss {

/// The mesh of each connected part of a surface, vertices and triangles in their order; what stands at the
/// same place is connected.
std::vector<TriangleMesh> connectedParts(const TriangleMesh& soup);

/// The vertex that lies farthest out in each of 26 directions, the first of equally far ones. The mesh has
/// some.
std::vector<std::size_t> farthestOut(const TriangleMesh& mesh);

} // namespace tss
