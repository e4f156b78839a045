#pragma once
#include "bake/bind/SkinGraph.h"

namespace tss {

/// A vertex's role in a cut: free, on the source's side, on the sink's side, or not in the graph.
enum class SkinSide : signed char { Either, Inside, Outside, Removed };

struct SkinCut {
    std::vector<char> inside; ///< #V: on the source's side
    double cost = 0;          ///< integral of the price along the cut, scene units squared
};

/// Minimum cut of a skin in two, by a maximum flow from Inside (sources) to Outside (sinks) with Dinic's
/// algorithm
/// ("Algorithm for solution of a problem of maximum flow in networks with power estimation", 1970). The
/// capacity of an edge is its dual length, which the cut runs along, times the price there.
class SkinCutter {
public:
    /// price: #V, cost of a cut per length, >= 0.
    SkinCutter(const TriangleMesh& skin, const SkinGraph& graph, const std::vector<double>& price);

    /// sides: #V; edges at Removed vertices cost nothing. Of cuts of equal cost that with the smallest
    /// inside.
    SkinCut cut(const std::vector<SkinSide>& sides) const;

private:
    struct Arc {
        std::uint32_t to = 0, back = 0; ///< vertex, and index of the reverse arc in its list
        double capacity = 0;            ///< residual capacity
    };
    class Flow;

    std::vector<std::vector<Arc>> arcs_; ///< per vertex
    double tolerance_ = 0;               ///< residual capacities up to this are rounding
};

} // namespace tss
