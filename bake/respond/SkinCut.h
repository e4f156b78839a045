#pragma once
#include "bake/respond/SkinGraph.h"

namespace tss {

enum class SkinSide : signed char { Either, Inside, Outside, Removed };

struct SkinCut {
    std::vector<char> inside; ///< #V
    double cost = 0;          ///< price times length along it, scene units squared
};

/// Parts a skin in two by the cut that costs least: a largest flow from what is inside to what is outside by
/// Dinic's method ("Algorithm for solution of a problem of maximum flow in networks with power estimation",
/// 1970), over the dual lengths of edges.
class SkinCutter {
public:
    /// price: #V, what a cut costs there per length, >= 0.
    SkinCutter(const TriangleMesh& skin, const SkinGraph& graph, const std::vector<double>& price);

    /// sides: #V; what is removed may be cut for nothing. Of cuts that cost the same the one with the least
    /// inside.
    SkinCut cut(const std::vector<SkinSide>& sides) const;

private:
    struct Arc {
        std::uint32_t to = 0, back = 0; ///< vertex, and the place of the arc the other way in its list
        double room = 0;                ///< for more flow
    };
    class Flow;

    std::vector<std::vector<Arc>> arcs_; ///< of each vertex
    double none_ = 0;                    ///< room that is rounding
};

} // namespace tss
