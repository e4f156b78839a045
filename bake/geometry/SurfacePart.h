#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <array>
#include <compare>
#include <cstdint>

namespace tss {

/// Cuts the longest edge in half, the first of equal ones: (a, middle, c) and (middle, b, c), where the edge
/// runs from a to b and c is the corner opposite. Edges are compared by (x^2 + y^2) + z^2 in double.
std::array<Corners, 2> halves(const Corners& corners);

/// A part of a triangle of a mesh: its longest edge cut in half again and again. Plain data, as files hold
/// it.
struct SurfacePart {
    std::uint32_t triangle = 0; ///< index into TriangleMesh::triangles, as loaded and before any cleaning
    std::uint32_t cuts = 1;     ///< a leading 1, then a bit per cut, first cut first: which half is meant

    friend auto operator<=>(const SurfacePart&,
                            const SurfacePart&) = default; // NOLINT(modernize-use-nullptr)
};

/// How often a part may be cut: what fits into SurfacePart::cuts.
constexpr int mostCuts = 31;

/// The corners of a part. The triangle must be one of the mesh's, cuts at least 1.
Corners corners(const TriangleMesh& mesh, SurfacePart part);

} // namespace tss
