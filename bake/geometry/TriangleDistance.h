#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <array>

namespace tss {

/// Squared distance of the segments a, b and c, d.
double squaredDistanceOfSegments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

using TriangleCorners = std::array<Vec3, 3>;

/// Squared distance of two triangles, 0 where they cross. Right to rounding also for slivers and for
/// triangles that are a segment or a point.
double squaredDistanceOfTriangles(const TriangleCorners& s, const TriangleCorners& t);

} // namespace tss
