#pragma once
#include "bake/base/Lists.h"
#include "bake/geometry/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace tss {

/// Unit normals of all vertices, weighted by area: those of SkinResponse at rest.
std::vector<Vec3> skinNormals(const TriangleMesh& skin);

/// Two triangles around a vertex v that share the edge (v, middle), or one: together their area vectors are
/// half of (middle - v) x (last - first).
struct SkinFan {
    std::uint32_t middle = 0, last = 0, first = 0;
};

/// The triangles around each of the first `count` vertices that they name, two at a time where they share an
/// edge.
Lists<SkinFan> skinFans(const std::vector<Tri>& triangles, std::size_t count);

} // namespace tss
