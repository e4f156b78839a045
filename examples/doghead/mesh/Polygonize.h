#pragma once
#include "examples/doghead/implicit/Field.h"

namespace doghead {

/// The surface of a field as a closed, outward oriented mesh, by marching tetrahedra (each cell of a cubic
/// grid in six around its diagonal: closed and manifold whatever the field does). Blocks of cells far from
/// the surface are skipped, trusting the field to be right within a factor of two. The triangles are raw: see
/// remesh().
tss::TriangleMesh polygonize(const Field& field, double cell);

} // namespace doghead
