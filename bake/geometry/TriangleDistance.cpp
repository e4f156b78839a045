#include "bake/geometry/TriangleDistance.h"

#include "bake/geometry/TrianglePoint.h"

#include <algorithm>

namespace tss {
namespace {

/// The segment from p to q goes through the triangle's inside.
bool pierces(const Vec3& p, const Vec3& q, const TriangleCorners& t, const Vec3& normal) {
    const double before = normal.dot(p - t[0]), after = normal.dot(q - t[0]);
    if (!(before * after < 0)) return false;
    const Vec3 x = p + before / (before - after) * (q - p);
    for (int k = 0; k < 3; ++k)
        if (!((t[(k + 1) % 3] - t[k]).cross(x - t[k]).dot(normal) >= 0)) return false;
    return true;
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

double squaredDistanceOfTriangles(const TriangleCorners& s, const TriangleCorners& t) {
    const Vec3 normalS = (s[1] - s[0]).cross(s[2] - s[0]), normalT = (t[1] - t[0]).cross(t[2] - t[0]);
    for (int k = 0; k < 3; ++k)
        if (pierces(s[k], s[(k + 1) % 3], t, normalT) || pierces(t[k], t[(k + 1) % 3], s, normalS)) return 0;
    // Apart, the nearest pair has a corner of one of them in it, or lies on an edge of each.
    double best = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        best = std::min(best, (closestOnTriangle(s[k], t[0], t[1], t[2]) - s[k]).squaredNorm());
        best = std::min(best, (closestOnTriangle(t[k], s[0], s[1], s[2]) - t[k]).squaredNorm());
        for (int j = 0; j < 3; ++j)
            best = std::min(best, squaredDistanceOfSegments(s[k], s[(k + 1) % 3], t[j], t[(j + 1) % 3]));
    }
    return best;
}

} // namespace tss
