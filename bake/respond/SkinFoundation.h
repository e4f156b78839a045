#pragma once
#include "bake/base/Lists.h"
#include "bake/respond/SkinGraph.h"

namespace tss {

/// Some of a node or a vertex.
struct SkinEntry {
    std::uint32_t index = 0;
    float value = 0;
};

/// The answer of a skin to a push, tabulated (METHOD 6.5). The skin is an elastic sheet with stretch and
/// bending on an elastic foundation, B = b l^2 L M^-1 L + s L + M / l^2, which never changes; what one push
/// does is a column of its inverse, and dies away within a few lengths l. Pushes and moves live on nodes, of
/// which every vertex has a few: a vertex that is pushed by a force f pushes its nodes by their weights, and
/// moves by the weighted mean of how they move. Columns are cut where they have died away, so what is pushed
/// is exactly what is tabulated, and scalar, so that they serve whatever way the skin is turned.
struct SkinFoundation {
    double length = 0; ///< l
    std::size_t nodes = 0;
    Lists<SkinEntry> weights;  ///< of each vertex on nodes, 1 together; of those never moved none
    Lists<SkinEntry> columns;  ///< of each node, empty where nothing pushes; the largest of all is 1
    Lists<SkinEntry> vertices; ///< of each node, with their weights

    std::size_t bytes() const;
};

/// pushed: #V, whether a contact may push the vertex. firmness: #V, >= 1, factors on the foundation. length:
/// l, scene units. stretchCompliance, bendCompliance: >= 0; at 1 the term is half as stiff. Vertices out of
/// reach of all pushes get no nodes.
SkinFoundation skinFoundation(const TriangleMesh& skin, const SkinGraph& graph,
                              const std::vector<bool>& pushed, const std::vector<double>& firmness,
                              double length, double stretchCompliance, double bendCompliance);

} // namespace tss
