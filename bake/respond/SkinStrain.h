#pragma once
#include "bake/respond/SkinKernels.h"
#include "bake/respond/SkinSolver.h"
#include "bake/respond/SkinTurn.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// The vertices of a plane of a patch, in the whole sheet.
inline std::array<std::uint32_t, 3> cornersOf(const SheetPlane& plane, std::span<const std::uint32_t> patch) {
    return {patch[plane.vertex[0]], patch[plane.vertex[1]], patch[plane.vertex[2]]};
}

/// Where muscles pull a skin apart, or a contact lifts one layer of a fold from the other, linear springs let
/// some edges stretch many times over and triangles turn over. Here neighbours then give up some of the
/// difference of their displacements, until edges are between shortestEdge and longestEdge of their length at
/// rest and no triangle is turned over. Each step averages displacements, so that nothing ever grows; what is
/// within its limits is not touched, and what is hardly beyond them hardly moves: skin that comes near a
/// limit does not jump. Rounds are limited: what is torn over very many edges may stay beyond. Contacts have
/// their say in between, to be no deeper than they were. No state but its own scratch memory.
class SkinStrain {
public:
    explicit SkinStrain(const SkinWeave& weave, KernelTarget target = KernelTarget::Best);

    /// positions: #vertices, changed. planes: contacts as the sheet lies at rest, with vertices of a patch;
    /// patch: its vertices; without: #vertices, the displacement that the bounds of the planes are relative
    /// to; turn: of the shape at rest that each place strives for. Returns the number of links and triangles
    /// that are still beyond their limits.
    std::size_t relax(std::span<const Vec3> rest, std::span<const SheetPlane> planes,
                      std::span<const std::uint32_t> patch, std::span<const Move> without,
                      const SkinTurn& turn, std::span<Vec3> positions);

private:
    bool relaxLink(std::uint32_t link, std::span<const Vec3> rest, const SkinTurn& turn,
                   std::span<Vec3> positions) const;
    bool relaxTriangle(std::uint32_t t, std::span<const Vec3> rest, const SkinTurn& turn,
                       std::span<Vec3> positions) const;
    void survey(const SkinTurn& turn, std::span<const Vec3> positions);
    void markAround(std::uint32_t vertex);
    bool touch(std::uint32_t vertex); ///< whether for the first time in this round
    void listPresses(std::span<const SheetPlane> planes, std::span<const std::uint32_t> patch);
    void press(std::span<const SheetPlane> planes, std::span<const Vec3> rest, std::span<const Move> without,
               const SkinTurn& turn, std::span<Vec3> positions);
    void gather();

    /// A contact that is in use, and its vertices in the whole sheet.
    struct Press {
        std::uint32_t plane = 0;
        std::array<std::uint32_t, 3> corners{};
    };

    const SkinWeave& weave_;
    const SkinKernels& kernels_;
    std::vector<SkinPlace> places_;
    std::vector<std::uint64_t> linkMarks_, triangleMarks_; ///< a bit each: to be looked at in the first round
    std::vector<Press> presses_;
    std::vector<std::uint32_t> pressStart_, pressOf_; ///< of each vertex in presses_, as in SkinWeave
    std::vector<std::uint64_t> pressMarks_;           ///< a bit each: to be looked at in this round
    std::vector<std::uint32_t> links_, triangles_, moved_;
    std::vector<std::uint32_t> linkRound_, triangleRound_, vertexRound_;
    std::uint32_t round_ = 0;
};

} // namespace tss
