#pragma once
#include "bake/respond/SkinSheet.h"

#include <array>
#include <span>

namespace tss {

/// Where the lanes of a vertex start in a list of displacements.
using LaneStart = std::uint32_t;
inline LaneStart laneStart(std::uint32_t vertex) {
    return 4 * vertex;
}

/// Eight edges that share no vertex. A place that is left over holds an edge of no length with both ends at
/// the vertex past the last.
struct EdgePack {
    alignas(32) float direction[8][4]; ///< of edge n: at slot(n), so that n and n + 4 lie side by side
    float compliance[8], inverse[8];
    LaneStart i[8], j[8];

    static std::size_t slot(std::size_t n) { return 2 * (n % 4) + n / 4; }
};

/// Two bends that share no vertex, each about the plain mean of a ring of the same size.
struct BendPack {
    alignas(32) float compliance[8], inverse[8]; ///< of each three times, then 0
    LaneStart centre[2];
    std::uint32_t first; ///< PackedSheet::ring[first + 2 k + b]: neighbour k of bend b
    std::uint32_t size;  ///< of each ring
};

/// A bend about a weighted mean of two neighbours, as along a rim.
struct RimBend {
    std::uint32_t centre, neighbour[2];
    float share[2];
    float compliance, inverse;
};

/// A range of each kind of constraints, all near each other, so that what they read and write stays in the
/// nearest cache.
struct SheetBlock {
    std::uint32_t edges = 0, bends = 0, rims = 0; ///< past the last of them; the first is where the block
                                                  ///< before ends
};

/// A sheet as the kernels sweep over it. Immutable, shared by all instances.
struct PackedSheet {
    std::vector<float> inverseMass; ///< #vertices and 0 for the one past the last
    std::vector<float> mass;        ///< 1 / inverseMass; 0: fixed
    std::vector<SheetBlock> blocks;
    std::vector<EdgePack> edges;
    std::vector<BendPack> bends;
    std::vector<RimBend> rims;
    std::vector<LaneStart> ring;

    std::size_t vertexCount() const { return mass.size() - 1; }
};

/// A part of a sheet; what lies around it does not move.
struct SheetPatch {
    std::vector<std::uint32_t> vertices; ///< of the whole sheet, rising
    PackedSheet sheet;                   ///< its own indices are into `vertices`
};

/// inside: #vertices of the whole sheet, whose vertices should be so numbered that near numbers are near
/// places.
SheetPatch patchOf(const SkinSheet& whole, const std::vector<bool>& inside);

} // namespace tss
