#pragma once
#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace tss {

/// x, y, z of a displacement and a fourth lane: one aligned load.
using Move = Eigen::Vector4f;

/// direction . (u_i - u_j) = 0, direction along the edge at rest.
struct SheetEdge {
    Move direction; ///< the fourth lane is 0
    std::uint32_t i = 0, j = 0;
    float compliance = 0;
    float inverse = 0; ///< 1 / (w_i + w_j + compliance)
};

/// u_centre - weighted mean of u over the ring = 0: three equations at once.
struct SheetBend {
    std::uint32_t centre = 0, first = 0, last = 0; ///< ring: range in SkinSheet::ring
    float compliance = 0, inverse = 0;
};

/// An elastic sheet in which all equations are linear in the displacements (METHOD 6.3), so that the problem
/// is convex: one answer, whatever came before. Immutable.
struct SkinSheet {
    std::vector<float> inverseMass; ///< w of each vertex, with everything that holds it; 0: fixed
    std::vector<SheetEdge> edges;
    std::vector<SheetBend> bends;
    std::vector<std::uint32_t> ring;
    std::vector<float> ringShare; ///< #ring: what that vertex weighs in the mean, 1 together
};

} // namespace tss
