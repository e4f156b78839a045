#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <vector>

namespace doghead {

using tss::Tri;
using tss::Vec3;

/// A closed manifold mesh whose edges can be split, collapsed and flipped. Each operation that would break
/// the manifold or turn a triangle over is refused.
class EditableMesh {
public:
    explicit EditableMesh(const tss::TriangleMesh& mesh);

    tss::TriangleMesh mesh() const; ///< without the dead vertices and triangles

    std::vector<Vec3> vertices;
    std::vector<Tri> triangles;           ///< [0] is -1 where dead
    std::vector<std::vector<int>> around; ///< of each vertex: its triangles, empty where dead

    struct Edge {
        int a, b;        ///< vertices
        int left, right; ///< triangles: (a, b, .) and (b, a, .)
    };
    /// Every edge once, a < b, in the order of the triangles.
    std::vector<Edge> edges() const;
    /// The edge as it is now; false when it is gone.
    bool find(int a, int b, Edge& edge) const;

    int opposite(int triangle, int a, int b) const;
    Vec3 areaNormal(int triangle) const;           ///< twice the area long
    std::vector<int> neighbours(int vertex) const; ///< sorted

    int split(const Edge& edge, const Vec3& at);
    /// b is drawn into a, which moves to `at`. No edge gets longer than `longest`. With `facing` the
    /// triangles left need not face as they did, only to the side of that normal: this is how a fold is taken
    /// out.
    bool collapse(const Edge& edge, const Vec3& at, double longest, const Vec3* facing = nullptr);
    bool flip(const Edge& edge, double leastQuality);

private:
    bool turnsOver(int vertex, const Vec3& at, const Edge& except, const Vec3* facing) const;
    void dropTriangle(int triangle);
};

/// 1 for an equilateral triangle, 0 for a degenerate one: 4 sqrt(3) area / sum of squared edges.
double quality(const Vec3& a, const Vec3& b, const Vec3& c);

} // namespace doghead
