#pragma once
#include "bake/base/Lists.h"
#include "bake/geometry/TriangleMesh.h"

#include <Eigen/SparseCore>

#include <cstdint>
#include <span>
#include <vector>

namespace tss {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The edge graph of a skin.
struct SkinGraph {
    struct Edge {
        std::uint32_t to = 0;
        double length = 0; ///< scene units
    };
    Lists<Edge> edges;        ///< of each vertex
    std::vector<double> area; ///< #V: a third of that of the triangles around, > 0; scene units squared
    double meanEdge = 0;      ///< scene units

    std::size_t vertices() const { return area.size(); }
};

SkinGraph skinGraph(const TriangleMesh& skin);

/// Dijkstra's algorithm: lowers each distance to the shortest one along edges from a source, where that is at
/// most `limit`. distance: #V, infinite where unknown. starts: #sources, initial distance of each; empty: 0.
/// Returns the vertices whose distance was lowered.
std::vector<std::uint32_t> lowerDistances(const SkinGraph& graph, std::span<const std::uint32_t> sources,
                                          double limit, std::vector<double>& distance,
                                          std::span<const double> starts = {});

/// The cotangent Laplacian: symmetric, rows sum to zero, no unit. Edge weights are clamped above 0 at obtuse
/// angles and slivers, so that what is diffused by it stays within its bounds. stiffness: #triangles factors;
/// empty: 1.
SparseMatrix skinLaplacian(const TriangleMesh& skin, std::span<const double> stiffness = {});

/// The indices of points in Morton order (Z-order curve), so that points near in space are near in memory.
std::vector<std::uint32_t> alongCurve(const std::vector<Vec3>& points);

} // namespace tss
