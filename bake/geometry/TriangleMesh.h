#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace tss {

using Vec3 = Eigen::Vector3d;
using Tri = Eigen::Vector3i;

/// A triangle mesh, counter-clockwise seen from outside. Plain data; auditMesh() says what is wrong with one.
struct TriangleMesh {
    std::vector<Vec3> vertices; ///< #V points, scene units, in the body's own frame
    std::vector<Tri> triangles; ///< #F index triples, 0 <= index < #V

    bool empty() const { return triangles.empty(); }
    const Vec3& corner(std::size_t triangle, int k) const { return vertices[triangles[triangle][k]]; }
};

/// Axis-aligned bounds of the vertices; empty() when there is none.
inline Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Vec3& v : mesh.vertices) box.extend(v);
    return box;
}

/// The length of the bounding box's diagonal, in the mesh's units; at least one vertex.
inline double diagonal(const TriangleMesh& mesh) {
    return bounds(mesh).diagonal().norm();
}

} // namespace tss
