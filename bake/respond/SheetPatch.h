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

/// A range of vertices and of each kind of constraints, all near each other: what is swept, or left alone,
/// together. Numbers are past the last of each kind; the first is where the block before ends.
struct SheetBlock {
    std::uint32_t vertices = 0, edges = 0, bends = 0, rims = 0;
};

/// Lists, one behind the other: those of k from start[k] to start[k + 1].
struct SheetLists {
    std::vector<std::uint32_t> start{0}, at;

    std::span<const std::uint32_t> operator[](std::size_t k) const {
        return {at.data() + start[k], at.data() + start[k + 1]};
    }
};

/// A sheet as the kernels sweep over it. Immutable, shared by all instances.
struct PackedSheet {
    static constexpr std::uint32_t blockSize = 64; ///< vertices of each block but the last

    std::vector<float> inverseMass; ///< #vertices and 0 for the one past the last
    std::vector<float> mass;        ///< 1 / inverseMass; 0: fixed
    std::vector<SheetBlock> blocks;
    std::vector<EdgePack> edges;
    std::vector<BendPack> bends;
    std::vector<RimBend> rims;
    std::vector<LaneStart> ring;
    SheetLists owners; ///< of each vertex: the blocks whose constraints move it, its own first
    SheetLists halo;   ///< of each block: the vertices of others that its constraints move, rising

    std::size_t vertexCount() const { return mass.size() - 1; }
    SheetBlock blockStart(std::size_t block) const { return block > 0 ? blocks[block - 1] : SheetBlock{}; }
    static std::uint32_t blockOf(std::uint32_t vertex) { return vertex / blockSize; }
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
