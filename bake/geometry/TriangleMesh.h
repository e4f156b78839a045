#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

namespace tss {

using Vec3 = Eigen::Vector3d;
using Tri = Eigen::Vector3i;

/// The three corners of a triangle, or of a part of one.
using Corners = std::array<Vec3, 3>;

/// A triangle mesh, counter-clockwise seen from outside. Plain data; auditMesh() says what is wrong with one.
struct TriangleMesh {
    std::vector<Vec3> vertices; ///< #V points, scene units, in the body's own frame
    std::vector<Tri> triangles; ///< #F index triples, 0 <= index < #V

    bool empty() const { return triangles.empty(); }
    const Vec3& corner(std::size_t triangle, int k) const { return vertices[triangles[triangle][k]]; }
    Corners corners(std::size_t triangle) const {
        return {corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)};
    }
    /// Outward normal of a triangle, as long as twice the triangle's area.
    Vec3 areaNormal(std::size_t triangle) const {
        const Vec3& a = corner(triangle, 0);
        return (corner(triangle, 1) - a).cross(corner(triangle, 2) - a);
    }
};

/// Axis-aligned bounds of the vertices; empty() when there is none.
inline Eigen::AlignedBox3d bounds(const TriangleMesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const Vec3& v : mesh.vertices) box.extend(v);
    return box;
}

/// Axis-aligned bounds of one triangle.
inline Eigen::AlignedBox3d bounds(const TriangleMesh& mesh, std::size_t triangle) {
    Eigen::AlignedBox3d box(mesh.corner(triangle, 0));
    return box.extend(mesh.corner(triangle, 1)).extend(mesh.corner(triangle, 2));
}

/// The length of the bounding box's diagonal, in the mesh's units; at least one vertex.
inline double diagonal(const TriangleMesh& mesh) {
    return bounds(mesh).diagonal().norm();
}

} // namespace tss
