#pragma once
#include "bake/geometry/WideBvh.h"

namespace tss {

/// Where on a triangle mesh the point nearest to another lies.
struct NearestPoint {
    int triangle = -1;           ///< -1: none within the range asked for
    Vec3 weights = Vec3::Zero(); ///< barycentric, >= 0, sum 1
    Vec3 point = Vec3::Zero();
    double distance = 0;
};

/// Barycentric weights of the point of triangle (a, b, c) nearest to x. A triangle without area answers with
/// its nearest edge or corner.
template <class T>
Eigen::Matrix<T, 3, 1> nearestOnTriangle(const Eigen::Matrix<T, 3, 1>& x, const Eigen::Matrix<T, 3, 1>& a,
                                         const Eigen::Matrix<T, 3, 1>& b, const Eigen::Matrix<T, 3, 1>& c) {
    using Vec = Eigen::Matrix<T, 3, 1>;
    // Voronoi regions of corners and edges first; what is left projects into the face.
    const Vec ab = b - a, ac = c - a, ax = x - a;
    const T d1 = ab.dot(ax), d2 = ac.dot(ax);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const Vec bx = x - b;
    const T d3 = ab.dot(bx), d4 = ac.dot(bx);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const T vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        const T t = d1 > d3 ? d1 / (d1 - d3) : 0;
        return {1 - t, t, 0};
    }
    const Vec cx = x - c;
    const T d5 = ab.dot(cx), d6 = ac.dot(cx);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const T vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        const T t = d2 > d6 ? d2 / (d2 - d6) : 0;
        return {1 - t, 0, t};
    }
    const T va = d3 * d6 - d5 * d4;
    const T e = d4 - d3, f = d5 - d6;
    if (va <= 0 && e >= 0 && f >= 0) {
        const T t = e + f > 0 ? e / (e + f) : 0;
        return {0, 1 - t, t};
    }
    const T sum = va + vb + vc;
    if (!(sum > 0)) return {1, 0, 0};
    return {va / sum, vb / sum, vc / sum};
}

/// Unit normals of the vertices, weighted by angle; zero for a vertex of no triangle with area.
std::vector<Vec3> vertexNormals(const TriangleMesh& mesh);

/// Closest-point queries that return barycentric weights and can be restricted to triangles that face a
/// direction. Keeps a reference to the mesh, which must have no index out of range.
class ClosestPointQuery {
public:
    explicit ClosestPointQuery(const TriangleMesh& mesh);

    /// The nearest point that is nearer than `range`. Of equally near triangles the first visited counts.
    NearestPoint nearest(const Vec3& x, double range) const;

    /// Nearest among the triangles whose normal n has n . facing > 0. first: a triangle that is probably
    /// near, looked at before all others, -1: none; it changes how long the search takes, not what it finds.
    NearestPoint nearestFacing(const Vec3& x, double range, const Vec3& facing, int first = -1) const;

    /// A triangle that the segment crosses from its front to its back, -1: none.
    int entered(const Vec3& from, const Vec3& to) const;

private:
    NearestPoint search(const Vec3& x, double range, const Vec3& facing, int first) const;

    const TriangleMesh& mesh_;
    WideBvh bvh_;
};

} // namespace tss
