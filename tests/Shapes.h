#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <fstream>
#include <map>
#include <string>

/// An axis-aligned box, closed, outward.
inline tss::TriangleMesh boxMesh(const tss::Vec3& low, const tss::Vec3& high) {
    tss::TriangleMesh mesh;
    for (int k = 0; k < 8; ++k)
        mesh.vertices.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(),
                                   k & 4 ? high.z() : low.z());
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// A ball of triangles: an octahedron whose faces are split `level` times.
inline tss::TriangleMesh ballMesh(const tss::Vec3& centre, double radius, int level) {
    tss::TriangleMesh mesh;
    mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int k = 0; k < level; ++k) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [place, isNew] =
                middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<int>(mesh.vertices.size()));
            if (isNew) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]).normalized());
            return place->second;
        };
        std::vector<tss::Tri> finer;
        for (const tss::Tri& t : mesh.triangles) {
            const int x = middle(t[0], t[1]), y = middle(t[1], t[2]), z = middle(t[2], t[0]);
            for (const tss::Tri& part :
                 {tss::Tri(t[0], x, z), tss::Tri(x, t[1], y), tss::Tri(z, y, t[2]), tss::Tri(x, y, z)})
                finer.push_back(part);
        }
        mesh.triangles = finer;
    }
    for (tss::Vec3& v : mesh.vertices) v = centre + radius * v;
    return mesh;
}

/// The segment from a point along a vector meets a triangle of the mesh, from either side.
inline bool segmentMeets(const tss::Vec3& from, const tss::Vec3& way, const tss::TriangleMesh& mesh) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const tss::Vec3 a = mesh.corner(t, 0), ab = mesh.corner(t, 1) - a, ac = mesh.corner(t, 2) - a;
        const double det = ab.dot(way.cross(ac)), side = det < 0 ? -1 : 1;
        const tss::Vec3 s = from - a, sxab = s.cross(ab);
        const double u = side * s.dot(way.cross(ac)), v = side * way.dot(sxab), depth = side * ac.dot(sxab);
        if (det != 0 && u >= 0 && v >= 0 && u + v <= std::abs(det) && depth > 0 && depth <= std::abs(det))
            return true;
    }
    return false;
}

inline void writeObj(const tss::TriangleMesh& mesh, const std::string& file) {
    std::ofstream stream(file);
    stream.precision(17);
    for (const tss::Vec3& v : mesh.vertices) stream << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    for (const tss::Tri& t : mesh.triangles)
        stream << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}
