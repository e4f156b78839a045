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

/// Soon tells most triangles that are apart by more than a distance, given squared: by their planes, or by
/// those through an edge of one across it. False: it is not known.
bool surelyBeyond(const TriangleCorners& s, const TriangleCorners& t, double distance2);

} // namespace tss
