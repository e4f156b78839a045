#include "bake/motion/ClosestPointQuery.h"

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
    std::vector<Vec3> normals;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        normals.push_back(mesh.areaNormal(t).normalized());
    bvh_ = WideBvh(buildBvh(mesh, 1), normals);
}

NearestPoint ClosestPointQuery::search(const Vec3& x, double range, const Vec3& facing, int first) const {
    NearestPoint best;
    double bound = range * range;
    const bool any = facing.isZero(0);
    const auto probe = [&](std::uint32_t t) {
        if (!any && !(mesh_.areaNormal(t).dot(facing) > 0)) return;
        const Vec3 &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
        const Vec3 w = nearestOnTriangle(x, a, b, c);
        const Vec3 p = w[0] * a + w[1] * b + w[2] * c;
        const double d = (x - p).squaredNorm();
        if (!(d < bound)) return;
        bound = d;
        best = {static_cast<int>(t), w, p, std::sqrt(d)};
    };
    if (first >= 0) probe(static_cast<std::uint32_t>(first));
    bvh_.visitNearest(x, bound, facing, probe);
    return best;
}

NearestPoint ClosestPointQuery::nearest(const Vec3& x, double range) const {
    return search(x, range, Vec3::Zero(), -1);
}

NearestPoint ClosestPointQuery::nearestFacing(const Vec3& x, double range, const Vec3& facing,
                                              int first) const {
    return facing.isZero(0) ? NearestPoint{} : search(x, range, facing, first);
}

int ClosestPointQuery::entered(const Vec3& from, const Vec3& to) const {
    const Vec3 segment = to - from;
    int triangle = -1;
    bvh_.visitSegment(from, to, [&](std::uint32_t t) {
        const Vec3 &a = mesh_.corner(t, 0), &b = mesh_.corner(t, 1), &c = mesh_.corner(t, 2);
        const Vec3 normal = mesh_.areaNormal(t);
        const double along = normal.dot(segment), ahead = normal.dot(a - from);
        if (!(along < 0) || ahead > 0 || ahead < along) return false; // parallel, from behind, or not reached
        const Vec3 p = from + ahead / along * segment;
        if (normal.dot((b - a).cross(p - a)) < 0 || normal.dot((c - b).cross(p - b)) < 0 ||
            normal.dot((a - c).cross(p - c)) < 0)
            return false;
        triangle = static_cast<int>(t);
        return true;
    });
    return triangle;
}

} // namespace tss
