#pragma once
#include "bake/base/Lists.h"
#include "bake/geometry/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace tss {

/// Unit vertex normals weighted by triangle area, as SkinResponse has them at rest.
std::vector<Vec3> skinNormals(const TriangleMesh& skin);

/// The triangles around each of the first `count` vertices, as a closed ring of an even number of corners c0,
/// c1, ...: twice the sum of their area vectors is that of (c0 - v) x (c1 - c-1), (c2 - v) x (c3 - c1), and
/// so on, one cross product for two triangles. A ring that is no ring of the mesh names a corner twice, or v
/// itself. Rings of two vertices 2i and 2i + 1 are made equally long, and stand together: c0 of the one, c0
/// of the other, c1, ... A corner is named by its place among floats, four a vertex.
Lists<std::uint32_t> skinRings(const std::vector<Tri>& triangles, std::size_t count);

} // namespace tss
