#include "bake/motion/MuscleLocator.h"

#include <algorithm>
#include <cmath>

namespace tss {

Vec3 nearestOnTriangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
    // Voronoi regions of corners and edges first; what is left projects into the face.
    const Vec3 ab = b - a, ac = c - a, ax = x - a;
    const double d1 = ab.dot(ax), d2 = ac.dot(ax);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vec3 bx = x - b;
    const double d3 = ab.dot(bx), d4 = ac.dot(bx);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const double t = d1 > d3 ? d1 / (d1 - d3) : 0;
        return {1 - t, t, 0};
    }
    const Vec3 cx = x - c;
    const double d5 = ab.dot(cx), d6 = ac.dot(cx);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const double t = d2 > d6 ? d2 / (d2 - d6) : 0;
        return {1 - t, 0, t};
    }
    const double va = d3 * d6 - d5 * d4;
    const double e = d4 - d3, f = d5 - d6;
    if (va <= 0 && e >= 0 && f >= 0) {
        const double t = e + f > 0 ? e / (e + f) : 0;
        return {0, 1 - t, t};
    }
    const double sum = va + vb + vc;
    if (!(sum > 0)) return {1, 0, 0};
    return {va / sum, vb / sum, vc / sum};
}

std::vector<Vec3> vertexNormals(const TriangleMesh& mesh) {
    std::vector<Vec3> normals(mesh.vertices.size(), Vec3::Zero());
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const Vec3& p = mesh.vertices[t[k]];
            const Vec3 u = mesh.vertices[t[(k + 1) % 3]] - p, v = mesh.vertices[t[(k + 2) % 3]] - p;
            const Vec3 cross = u.cross(v);
            const double length = cross.norm();
            if (length > 0) normals[t[k]] += std::atan2(length, u.dot(v)) / length * cross;
        }
    for (Vec3& n : normals)
        if (const double length = n.norm(); length > 0) n /= length;
    return normals;
}

MuscleLocator::MuscleLocator(const TriangleMesh& mesh) : mesh_(mesh) {
    std::vector<Eigen::AlignedBox3d> boxes(mesh.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t)
        for (int k = 0; k < 3; ++k) boxes[t].extend(mesh.corner(t, k));
    bvh_ = buildBvh(boxes);
}

template <class Accept>
NearestPoint MuscleLocator::search(const Vec3& x, double range, const Accept& accept) const {
    NearestPoint best;
    double bound = range * range;
    visitNearest(bvh_, x, bound, [&](std::uint32_t t) {
        if (!accept(t)) return;
        const Vec3 &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
        const Vec3 w = nearestOnTriangle(x, a, b, c);
        const Vec3 p = w[0] * a + w[1] * b + w[2] * c;
        const double d = (x - p).squaredNorm();
        if (!(d < bound)) return;
        bound = d;
        best = {static_cast<int>(t), w, p, std::sqrt(d)};
    });
    return best;
}

NearestPoint MuscleLocator::nearest(const Vec3& x, double range) const {
    return search(x, range, [](std::uint32_t) { return true; });
}

NearestPoint MuscleLocator::nearestFacing(const Vec3& x, double range, const Vec3& facing) const {
    return search(x, range, [&](std::uint32_t t) {
        const Vec3& a = mesh_.corner(t, 0);
        return (mesh_.corner(t, 1) - a).cross(mesh_.corner(t, 2) - a).dot(facing) > 0;
    });
}

bool MuscleLocator::entered(const Vec3& from, const Vec3& to) const {
    if (bvh_.empty()) return false;
    const Vec3 way = to - from;
    const Vec3 inverse = way.cwiseInverse();
    std::vector<std::uint32_t> stack{0};
    while (!stack.empty()) {
        const Bvh::Node& node = bvh_.nodes[stack.back()];
        stack.pop_back();
        double first = 0, last = 1;
        for (int k = 0; k < 3; ++k) {
            if (way[k] == 0) {
                if (from[k] < node.lower[k] || from[k] > node.upper[k]) last = -1;
                continue;
            }
            const double s = (node.lower[k] - from[k]) * inverse[k],
                         t = (node.upper[k] - from[k]) * inverse[k];
            first = std::max(first, std::min(s, t));
            last = std::min(last, std::max(s, t));
        }
        if (first > last) continue;
        for (std::uint32_t i = 0; i < node.count; ++i) {
            const std::uint32_t t = bvh_.items[node.first + i];
            const Vec3 &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
            const Vec3 normal = (b - a).cross(c - a);
            const double along = normal.dot(way), ahead = normal.dot(a - from);
            if (!(along < 0) || ahead > 0 || ahead < along) continue; // the front faces where it comes from
            const Vec3 p = from + ahead / along * way;
            if (normal.dot((b - a).cross(p - a)) >= 0 && normal.dot((c - b).cross(p - b)) >= 0 &&
                normal.dot((a - c).cross(p - c)) >= 0)
                return true;
        }
        if (node.count == 0) {
            stack.push_back(node.first);
            stack.push_back(node.first + 1);
        }
    }
    return false;
}

} // namespace tss
