// The regions of a triangle after Ericson, "Real-Time Collision Detection", 2005, 5.1.5; the solid angle
// after Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983.
#include "bake/geometry/TrianglePoint.h"

#include <algorithm>
#include <cmath>

namespace tss {

Vec3 closestOnSegment(const Vec3& p, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double length2 = ab.squaredNorm();
    if (!(length2 > 0)) return a;
    const double t = (p - a).dot(ab) / length2;
    if (t <= 0) return a;
    if (t >= 1) return b;
    return a + t * ab;
}

namespace {

/// For slivers and for points far away, where differences of long products cancel: the best of the edges and
/// of the foot on the plane, which is compared with the edges from nearby.
Vec3 closestByEdges(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    Vec3 best = a;
    for (const Vec3& q : {closestOnSegment(p, a, b), closestOnSegment(p, b, c), closestOnSegment(p, c, a)})
        if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
    const Vec3 normal = (b - a).cross(c - a);
    const double area2 = normal.squaredNorm();
    if (!(area2 > 0)) return best;
    const Vec3 foot = p - (normal.dot(p - a) / area2) * normal;
    const bool inside = (b - a).cross(foot - a).dot(normal) >= 0 &&
                        (c - b).cross(foot - b).dot(normal) >= 0 && (a - c).cross(foot - c).dot(normal) >= 0;
    return inside && (foot - p).squaredNorm() < (best - p).squaredNorm() ? foot : best;
}

} // namespace

Vec3 closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    // Regions of Voronoi as in Ericson, Real-Time Collision Detection, 5.1.5.
    const Vec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    if (d1 <= 0 && d2 <= 0) return a;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0 && d4 <= d3) return b;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0 && d5 <= d6) return c;

    const Vec3 normal = ab.cross(ac);
    const double area2 = normal.squaredNorm();
    const double edge2 = std::max(ab.squaredNorm(), ac.squaredNorm());
    // Seen from far away, or in a sliver, the differences below cancel: then an edge is as near as the
    // inside.
    const bool sound = area2 > 1e-8 * edge2 * edge2 && ap.squaredNorm() < 1e8 * edge2;
    const double vc = d1 * d4 - d3 * d2;
    const double vb = d5 * d2 - d1 * d6;
    const double va = d3 * d6 - d5 * d4;
    if (sound) {
        if (vc <= 0 && d1 >= 0 && d3 <= 0) return closestOnSegment(p, a, b);
        if (vb <= 0 && d2 >= 0 && d6 <= 0) return closestOnSegment(p, a, c);
        if (va <= 0 && d4 >= d3 && d5 >= d6) return closestOnSegment(p, b, c);
    }
    const double sum = va + vb + vc;
    if (!sound || !(va > 0 && vb > 0 && vc > 0)) return closestByEdges(p, a, b, c);
    return a + (vb / sum) * ab + (vc / sum) * ac;
}

double solidAngle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = a - p, v = b - p, w = c - p;
    const double lu = u.norm(), lv = v.norm(), lw = w.norm();
    const double numerator = u.dot(v.cross(w));
    const double denominator = lu * lv * lw + u.dot(v) * lw + v.dot(w) * lu + w.dot(u) * lv;
    if (numerator == 0) return 0; // in the plane of the triangle: the two sides cancel
    return 2 * std::atan2(numerator, denominator);
}

} // namespace tss
