#pragma once
#include "tests/Shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

namespace tss::test {

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

/// Each triangle as four, `rounds` times.
inline TriangleMesh quartered(TriangleMesh mesh, int rounds) {
    for (; rounds > 0; --rounds) {
        std::map<std::pair<int, int>, int> middles;
        const auto middle = [&](int a, int b) {
            const auto [at, made] =
                middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
            if (made) mesh.vertices.push_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
            return at->second;
        };
        std::vector<Tri> finer;
        for (const Tri& t : mesh.triangles) {
            const int a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
            finer.insert(finer.end(), {{t[0], a, c}, {a, t[1], b}, {c, b, t[2]}, {a, b, c}});
        }
        mesh.triangles = std::move(finer);
    }
    return mesh;
}

inline TriangleMesh turnedInsideOut(TriangleMesh mesh) {
    for (Tri& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

} // namespace tss::test
