#pragma once
#include "bake/base/Lists.h"
#include "bake/geometry/TriangleMesh.h"

#include <Eigen/SparseCore>

#include <cstdint>
#include <span>
#include <vector>

namespace tss {

using SparseMatrix = Eigen::SparseMatrix<double>;

/// The vertices of a skin as neighbours along its edges.
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

/// Lowers each distance to that along the edges from a source, as far as it is at most `limit`. distance: #V,
/// infinite where nothing is known. starts: #sources, how far each is itself; empty: 0. Returns the vertices
/// whose distance it has lowered.
std::vector<std::uint32_t> lowerDistances(const SkinGraph& graph, std::span<const std::uint32_t> sources,
                                          double limit, std::vector<double>& distance,
                                          std::span<const double> starts = {});

/// The cotangent Laplacian, symmetric, its rows summing to zero, without a unit. Angles beyond a right one
/// and slivers keep a small weight above 0, so that what is spread by it stays between its bounds. softness:
/// #triangles factors; empty: 1.
SparseMatrix skinLaplacian(const TriangleMesh& skin, std::span<const double> softness = {});

/// The indices of some points in the order of a curve that fills space (Morton's), so that what is near stays
/// near in memory.
std::vector<std::uint32_t> alongCurve(const std::vector<Vec3>& points);

} // namespace tss
