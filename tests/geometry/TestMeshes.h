#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace tss::test {

/// A box with outward triangles.
inline TriangleMesh boxMesh(const Vec3& lower, const Vec3& upper) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.vertices.emplace_back(i & 1 ? upper.x() : lower.x(), i & 2 ? upper.y() : lower.y(),
                                   i & 4 ? upper.z() : lower.z());
    mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return mesh;
}

/// A sphere from an octahedron, each triangle cut in four `levels` times: 8 * 4^levels triangles.
inline TriangleMesh ballMesh(const Vec3& centre, double radius, int levels) {
    std::vector<Vec3> points = {Vec3::UnitX(),  -Vec3::UnitX(), Vec3::UnitY(),
                                -Vec3::UnitY(), Vec3::UnitZ(),  -Vec3::UnitZ()};
    std::vector<Tri> triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                  {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
            if (fresh) points.push_back((points[a] + points[b]).normalized());
            return it->second;
        };
        std::vector<Tri> finer;
        for (const Tri& t : triangles) {
            const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    TriangleMesh mesh;
    for (const Vec3& p : points) mesh.vertices.push_back(centre + radius * p);
    mesh.triangles = std::move(triangles);
    return mesh;
}

inline double uniform(std::mt19937_64& random, double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random);
}

inline Vec3 uniformPoint(std::mt19937_64& random, double halfWidth) {
    const double x = uniform(random, -halfWidth, halfWidth), y = uniform(random, -halfWidth, halfWidth);
    return {x, y, uniform(random, -halfWidth, halfWidth)};
}

/// A closed lumpy body: a ball whose radius wavers smoothly, by at most `noise` of it.
inline TriangleMesh lumpyMesh(std::mt19937_64& random, int levels, double noise) {
    TriangleMesh mesh = ballMesh(Vec3::Zero(), 1, levels);
    const Vec3 a = uniformPoint(random, 4), b = uniformPoint(random, 7);
    for (Vec3& v : mesh.vertices) v *= 1 + noise * 0.5 * (std::sin(a.dot(v)) + std::cos(b.dot(v)));
    return mesh;
}

/// Triangles thrown at random: nothing joins, nothing is closed.
inline TriangleMesh soupMesh(std::mt19937_64& random, int triangles, double halfWidth, double size) {
    TriangleMesh mesh;
    for (int t = 0; t < triangles; ++t) {
        const Vec3 at = uniformPoint(random, halfWidth);
        for (int k = 0; k < 3; ++k) mesh.vertices.push_back(at + uniformPoint(random, size));
        mesh.triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    return mesh;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& other) {
    const auto offset = static_cast<int>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const Tri& t : other.triangles) mesh.triangles.emplace_back(t.array() + offset);
}

inline TriangleMesh transformed(TriangleMesh mesh, const Eigen::Affine3d& transform) {
    for (Vec3& v : mesh.vertices) v = transform * v;
    return mesh;
}

inline TriangleMesh turnedInsideOut(TriangleMesh mesh) {
    for (Tri& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

} // namespace tss::test
