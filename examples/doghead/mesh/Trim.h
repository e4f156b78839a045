#pragma once
#include "bake/geometry/TriangleMesh.h"

namespace doghead {

/// The part of a mesh behind a plane (where outward . (x - point) <= 0), open along the cut. Vertices near
/// the plane are drawn onto it first, so that the cut leaves no slivers.
tss::TriangleMesh trim(const tss::TriangleMesh& mesh, const tss::Vec3& point, const tss::Vec3& outward);

} // namespace doghead
