#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <tuple>
#include <vector>

namespace tss {

/// A directed edge that triangles run through `excess` times more often than its reverse.
struct OpenEdge {
    int from, to, excess;
};

/// Lower vertex, upper vertex, how much more often it is run through from the lower one than from the upper.
using EdgeUse = std::tuple<int, int, int>;

EdgeUse edgeUse(int from, int to, int times);

/// The edges that are not run through equally often in both directions.
std::vector<OpenEdge> unbalanced(std::vector<EdgeUse> edges);

/// Triangles that close the openings of a mesh without adding a vertex: over each connected set of open edges
/// a cone to that of its vertices which comes first. With them every edge is run through equally often in
/// both directions, whatever the mesh. Empty for a closed one.
std::vector<Tri> closingTriangles(const TriangleMesh& mesh);

} // namespace tss
