#pragma once
#include "bake/base/Lists.h"
#include "bake/geometry/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace tss {

/// Unit vertex normals weighted by triangle area, as SkinResponse has them at rest.
std::vector<Vec3> skinNormals(const TriangleMesh& skin);

/// Two triangles around a vertex v that share the edge (v, middle), or a single one with v itself as first
/// corner: the sum of their area vectors is half of (middle - v) x (last - first), one cross product for two.
struct SkinFan {
    std::uint32_t middle = 0, last = 0, first = 0;
};

/// The triangles around each of the first `count` vertices, grouped in pairs where they share an edge.
Lists<SkinFan> skinFans(const std::vector<Tri>& triangles, std::size_t count);

} // namespace tss
