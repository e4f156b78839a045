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

/// The point of the triangle a, b, c nearest to p. Right also for slivers and for triangles that are a
/// segment or a point: the result is always a point of the triangle, and its distance from p is too large by
/// rounding alone.
Vec3 closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// The point of the segment a, b nearest to p; a where both ends are one point.
Vec3 closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b);

/// Solid angle of the triangle seen from p, in [-2 pi, 2 pi]; positive where p is behind it (its normal
/// points away from p). Van Oosterom and Strackee 1983.
double solidAngle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace tss
