#pragma once
#include "bake/geometry/TriangleMesh.h"

namespace tss {

/// Squared distance of the segments a, b and c, d.
double squaredDistanceOfSegments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Squared distance of two triangles, 0 where they cross. Right to rounding also for slivers and for
/// triangles that are a segment or a point.
double squaredDistanceOfTriangles(const Corners& s, const Corners& t);

/// A quick test by separating axes: true where two triangles are certainly farther apart than a distance,
/// given squared, because their projections on some axis are. The axes are the normals of both triangles and
/// the directions in each plane across its edges. False where none of them shows it.
bool surelyBeyond(const Corners& s, const Corners& t, double distance2);

} // namespace tss
