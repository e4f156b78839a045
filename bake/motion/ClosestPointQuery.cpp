#include "bake/motion/ClosestPointQuery.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tss {

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

ClosestPointQuery::ClosestPointQuery(const TriangleMesh& mesh) : mesh_(mesh) {
    std::vector<Eigen::AlignedBox3d> boxes(mesh.triangles.size());
    for (std::size_t t = 0; t < boxes.size(); ++t)
        for (int k = 0; k < 3; ++k) boxes[t].extend(mesh.corner(t, k));
    bvh_ = buildBvh(boxes);
}

template <class Accept>
NearestPoint ClosestPointQuery::search(const Vec3& x, double range, int first, const Accept& accept) const {
    NearestPoint best;
    double bound = range * range;
    const auto probe = [&](std::uint32_t t) {
        if (!accept(t)) return;
        const Vec3 &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
        const Vec3 w = nearestOnTriangle(x, a, b, c);
        const Vec3 p = w[0] * a + w[1] * b + w[2] * c;
        const double d = (x - p).squaredNorm();
        if (!(d < bound)) return;
        bound = d;
        best = {static_cast<int>(t), w, p, std::sqrt(d)};
    };
    if (first >= 0) probe(static_cast<std::uint32_t>(first));
    visitNearest(bvh_, x, bound, probe);
    return best;
}

NearestPoint ClosestPointQuery::nearest(const Vec3& x, double range) const {
    return search(x, range, -1, [](std::uint32_t) { return true; });
}

NearestPoint ClosestPointQuery::nearestFacing(const Vec3& x, double range, const Vec3& facing,
                                              int first) const {
    return search(x, range, first, [&](std::uint32_t t) {
        const Vec3& a = mesh_.corner(t, 0);
        return (mesh_.corner(t, 1) - a).cross(mesh_.corner(t, 2) - a).dot(facing) > 0;
    });
}

int ClosestPointQuery::entered(const Vec3& from, const Vec3& to) const {
    if (bvh_.empty()) return -1;
    const Vec3 way = to - from;
    const Vec3 perWay = (way.array() == 0).select(Vec3::Zero(), way.array().inverse());
    std::array<std::uint32_t, 128> stack; // as visitNearest() has it
    std::size_t top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const Bvh::Node& node = bvh_.nodes[stack[--top]];
        double first = 0, last = 1;
        for (int k = 0; k < 3; ++k) {
            if (way[k] == 0) {
                if (from[k] < node.lower[k] || from[k] > node.upper[k]) last = -1;
                continue;
            }
            const double s = (node.lower[k] - from[k]) * perWay[k], t = (node.upper[k] - from[k]) * perWay[k];
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
                return static_cast<int>(t);
        }
        if (node.count == 0) {
            stack[top++] = node.first;
            stack[top++] = node.first + 1;
        }
    }
    return -1;
}

} // namespace tss
