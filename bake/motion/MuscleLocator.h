#pragma once
#include "bake/geometry/Bvh.h"

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
Vec3 nearestOnTriangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

/// Unit normals of the vertices, weighted by angle; zero for a vertex of no triangle with area.
std::vector<Vec3> vertexNormals(const TriangleMesh& mesh);

/// Nearest-point queries that know where on the triangle they end and can be told which triangles to see.
/// Keeps a reference to the mesh, which must have no index out of range.
class MuscleLocator {
public:
    explicit MuscleLocator(const TriangleMesh& mesh);

    /// The nearest point nearer than `range`. Of equally near triangles the first met answers.
    NearestPoint nearest(const Vec3& x, double range) const;

    /// Nearest among the triangles whose normal n has n . facing > 0.
    NearestPoint nearestFacing(const Vec3& x, double range, const Vec3& facing) const;

    /// Whether the straight way from one place to another goes in through a triangle's front.
    bool entered(const Vec3& from, const Vec3& to) const;

private:
    template <class Accept>
    NearestPoint search(const Vec3& x, double range, const Accept& accept) const;

    const TriangleMesh& mesh_;
    Bvh bvh_;
};

} // namespace tss
