#pragma once
#include "bake/geometry/TriangleMesh.h"
#include "examples/doghead/implicit/Field.h"

namespace doghead {

/// The surface of a field as a closed, outward oriented mesh, by marching tetrahedra (each cell of a cubic
/// grid in six around its diagonal: closed and manifold whatever the field does). Blocks of cells far from
/// the surface are skipped, trusting the field to be right within a factor of two. The triangles are raw: see
/// remesh().
tss::TriangleMesh polygonize(const Field& field, double cell);

/// How fine a mesh follows its field.
struct RemeshOptions {
    double deviation =
        0.1; ///< how far an edge may leave the surface it spans, mm; sets the edge length by curvature
    double shortest = 0.6;  ///< least edge length, mm
    double longest = 5;     ///< greatest edge length, mm
    double gradation = 0.5; ///< how fast the edge length may grow along the surface, mm a mm
    int rounds = 10;
    std::function<double(const Vec3&)> limit =
        {}; ///< greatest edge length at a place, mm; empty: longest everywhere
};

/// A well shaped mesh of the same surface: edges are split, collapsed and flipped towards the length that the
/// curvature asks for, vertices are evened out along the surface and brought back onto the field after each
/// round. Closed in, closed out; no triangle turns over. (After Botsch and Kobbelt, "A remeshing approach to
/// multiresolution modeling", 2004.)
tss::TriangleMesh remesh(const tss::TriangleMesh& raw, const Field& field, const RemeshOptions& options);

/// The part of a mesh inside of a solid, open along the cut. Vertices near the solid's surface are drawn onto
/// it first, so that the cut leaves no slivers.
tss::TriangleMesh trim(const tss::TriangleMesh& mesh, const Field& kept);

} // namespace doghead
