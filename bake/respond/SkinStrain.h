#pragma once
#include "bake/motion/Motion.h"
#include "bake/respond/SkinSolver.h"
#include "bake/respond/SkinTurn.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// Two neighbours of a skin.
struct SkinLink {
    std::uint32_t i = 0, j = 0;
    double squared = 0;           ///< of its length at rest
    float shareI = 0, shareJ = 0; ///< of what is to be given up, 1 together; 0: fixed
};

/// The vertices of a plane of a patch, in the whole sheet.
inline std::array<std::uint32_t, 3> cornersOf(const SheetPlane& plane, std::span<const std::uint32_t> patch) {
    return {patch[plane.vertex[0]], patch[plane.vertex[1]], patch[plane.vertex[2]]};
}

/// The edges and triangles of a skin that may move, and which of them meet at each vertex. Immutable.
struct SkinWeave {
    std::vector<SkinLink> links;
    std::vector<Tri> triangles;
    std::vector<Vec3> normals; ///< #triangles at rest, twice the area long
    std::vector<std::uint32_t> linkStart,
        linkOf; ///< of vertex v: linkOf[linkStart[v]] to linkOf[linkStart[v + 1]]
    std::vector<std::uint32_t> triangleStart, triangleOf;
};

/// inverseMass: of each vertex, 0 where it is fixed.
SkinWeave makeWeave(const std::vector<Vec3>& rest, const std::vector<Tri>& triangles,
                    const std::vector<float>& inverseMass);

/// Where muscles pull a skin apart, or a contact lifts one layer of a fold from the other, linear springs let
/// some edges stretch many times over and triangles turn over. Here neighbours then give up some of the
/// difference of their displacements, until edges are between shortestEdge and longestEdge of their length at
/// rest and no triangle is turned over. Each step averages displacements, so that nothing ever grows; what is
/// within its limits is not touched, and what is hardly beyond them hardly moves: skin that comes near a limit
/// does not jump. Rounds are limited: what is torn over very many edges may stay beyond. Contacts have their
/// say in between, to be no deeper than they were. No state but its own scratch memory.
class SkinStrain {
public:
    static constexpr double shortestEdge = 0.65, longestEdge = 1.5;
    static constexpr double slack = 1e-3; ///< of a limit, that an edge may be beyond it: it is only neared

    explicit SkinStrain(const SkinWeave& weave);

    /// positions: #vertices, changed. planes: contacts as the sheet lies at rest, with vertices of a patch;
    /// patch: its vertices; without: #vertices, the displacement that the bounds of the planes are relative
    /// to; turn: of the shape at rest that each place strives for. Returns the number of links and triangles
    /// that are still beyond their limits.
    std::size_t relax(std::span<const Vec3> rest, std::span<const SheetPlane> planes,
                      std::span<const std::uint32_t> patch, std::span<const Move> without,
                      const SkinTurn& turn, std::span<Vec3> positions);

private:
    bool relaxLink(const SkinLink& link, std::span<const Vec3> rest, const SkinTurn& turn,
                   std::span<Vec3> positions) const;
    bool relaxTriangle(std::uint32_t t, std::span<const Vec3> rest, const SkinTurn& turn,
                       std::span<Vec3> positions) const;
    void touch(std::uint32_t vertex);
    void press(std::span<const SheetPlane> planes, std::span<const std::uint32_t> patch,
               std::span<const Vec3> rest, std::span<const Move> without, const SkinTurn& turn,
               std::span<Vec3> positions);
    void gather();

    const SkinWeave& weave_;
    std::vector<std::uint32_t> links_, triangles_, moved_;
    std::vector<std::uint32_t> linkRound_, triangleRound_, vertexRound_;
    std::uint32_t round_ = 0;
};

} // namespace tss
