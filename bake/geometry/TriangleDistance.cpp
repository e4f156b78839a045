// The regions of a triangle after Ericson, "Real-Time Collision Detection", 2005, 5.1.5; the solid angle
// after Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983.
#include "bake/geometry/TriangleDistance.h"

#include "bake/base/Infinity.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

/// Whether the segment from p to q passes through the inside of the triangle.
bool pierces(const Vec3& p, const Vec3& q, const Corners& t, const Vec3& normal) {
    const double before = normal.dot(p - t[0]), after = normal.dot(q - t[0]);
    if (!(before * after < 0)) return false;
    const Vec3 x = p + before / (before - after) * (q - p);
    for (int k = 0; k < 3; ++k)
        if (!((t[(k + 1) % 3] - t[k]).cross(x - t[k]).dot(normal) >= 0)) return false;
    return true;
}

/// Whether the projections of two triangles on an axis n of any length are farther apart than a distance,
/// given squared, rounding counted against it.
bool separatedAlong(const Vec3& n, const Corners& s, const Corners& t, double distance2) {
    const double s0 = n.dot(s[0]), s1 = n.dot(s[1]), s2 = n.dot(s[2]);
    const double t0 = n.dot(t[0]), t1 = n.dot(t[1]), t2 = n.dot(t[2]);
    const double sLow = std::min({s0, s1, s2}), sHigh = std::max({s0, s1, s2});
    const double tLow = std::min({t0, t1, t2}), tHigh = std::max({t0, t1, t2});
    const double gap = std::max(tLow - sHigh, sLow - tHigh);
    if (!(gap > 0)) return false;
    const auto reach = [&](const Corners& c) {
        return std::max({c[0].squaredNorm(), c[1].squaredNorm(), c[2].squaredNorm()});
    };
    const double length2 = n.squaredNorm();
    const double sure = gap - 1e-15 * std::sqrt(length2 * std::max(reach(s), reach(t)));
    return sure > 0 && sure * sure > distance2 * length2 * (1 + 1e-12);
}

} // namespace

double squaredDistanceOfSegments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    // The nearest pair of two segments has an end in it, or lies inside both.
    double best = std::min(
        {(closestOnSegment(a, c, d) - a).squaredNorm(), (closestOnSegment(b, c, d) - b).squaredNorm(),
         (closestOnSegment(c, a, b) - c).squaredNorm(), (closestOnSegment(d, a, b) - d).squaredNorm()});
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = u.squaredNorm(), uv = u.dot(v), vv = v.squaredNorm(), det = uu * vv - uv * uv;
    if (!(det > 0)) return best;
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / det, t = (uu * v.dot(w) - uv * u.dot(w)) / det;
    if (det > 1e-6 * uu * vv) {
        if (s > 0 && s < 1 && t > 0 && t < 1) best = std::min(best, (w + s * u - t * v).squaredNorm());
    } else if (s > 0 && s < 1) {
        // Nearly parallel, s and t have few digits: from s across and back is as near as it matters.
        const Vec3 across = closestOnSegment(a + s * u, c, d);
        best = std::min(best, (closestOnSegment(across, a, b) - across).squaredNorm());
    }
    return best;
}

double squaredDistanceOfTriangles(const Corners& s, const Corners& t) {
    const Vec3 normalS = (s[1] - s[0]).cross(s[2] - s[0]), normalT = (t[1] - t[0]).cross(t[2] - t[0]);
    for (int k = 0; k < 3; ++k)
        if (pierces(s[k], s[(k + 1) % 3], t, normalT) || pierces(t[k], t[(k + 1) % 3], s, normalS)) return 0;
    // Apart, the nearest pair has a corner of one of them in it, or lies on an edge of each.
    double best = infinity;
    for (int k = 0; k < 3; ++k) {
        best = std::min(best, (closestOnTriangle(s[k], t[0], t[1], t[2]) - s[k]).squaredNorm());
        best = std::min(best, (closestOnTriangle(t[k], s[0], s[1], s[2]) - t[k]).squaredNorm());
        for (int j = 0; j < 3; ++j)
            best = std::min(best, squaredDistanceOfSegments(s[k], s[(k + 1) % 3], t[j], t[(j + 1) % 3]));
    }
    return best;
}

bool surelyBeyond(const Corners& s, const Corners& t, double distance2) {
    const Vec3 edgesS[] = {s[1] - s[0], s[2] - s[1], s[0] - s[2]};
    const Vec3 edgesT[] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
    const Vec3 normalS = edgesS[0].cross(edgesS[1]), normalT = edgesT[0].cross(edgesT[1]);
    if (separatedAlong(normalS, s, t, distance2) || separatedAlong(normalT, s, t, distance2)) return true;
    for (int k = 0; k < 3; ++k)
        if (separatedAlong(normalS.cross(edgesS[k]), s, t, distance2) ||
            separatedAlong(normalT.cross(edgesT[k]), s, t, distance2))
            return true;
    return false;
}

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
