#pragma once
#include "bake/base/Lists.h"
#include "bake/bind/SkinGraph.h"

namespace tss {

/// An entry of a sparse row or column: the index of a node, a vertex or the like, and its coefficient.
struct SkinEntry {
    std::uint32_t index = 0;
    float value = 0;
};

/// In lengths l: how far from a push a column reaches, and the skin deforms. Beyond, a column is below its
/// cut (it falls as exp(-0.87 r / l)).
constexpr double columnReach = 7;

/// The answer of a skin to a push, tabulated (METHOD 6.5). The skin is an elastic sheet with stretch and
/// bending on an elastic foundation, B = b l^2 L M^-1 L + s L + M / l^2, which never changes; what one push
/// does is a column of its inverse, and dies away within a few lengths l. Forces and displacements are
/// interpolated between nodes: a force on a vertex is distributed to its nodes by their weights, and the
/// vertex moves by the weighted mean of their displacements. Columns are truncated where they have died away;
/// they are scalar, so that they hold in whatever direction the push is.
struct SkinFoundation {
    double length = 0; ///< l, in the units of the skin that it was made for
    std::size_t nodes = 0;
    Lists<SkinEntry> weights; ///< per vertex: nodes and weights, sum 1; none for vertices that never move
    Lists<SkinEntry> columns; ///< per node: column of the inverse over nodes, scaled so that the largest
                              ///< entry of all is 1; empty for nodes that nothing pushes

    std::size_t bytes() const { return weights.bytes() + columns.bytes(); }
};

/// pushed: #V, whether a contact may push the vertex. firmness: #V, >= 1, factors on the foundation. length:
/// l, scene units. stretchCompliance, bendCompliance: >= 0; at 1 the term is half as stiff. Vertices out of
/// reach of all pushes get no nodes.
SkinFoundation skinFoundation(const TriangleMesh& skin, const SkinGraph& graph,
                              const std::vector<bool>& pushed, const std::vector<double>& firmness,
                              double length, double stretchCompliance, double bendCompliance);

} // namespace tss
