#pragma once
#include "bake/motion/ClosestPointQuery.h"

#include <limits>
#include <map>
#include <utility>

namespace tss {

/// A point of a surface: the end of a walk.
struct SurfacePoint {
    int triangle = -1;
    Eigen::Vector3f weights = Eigen::Vector3f::Zero(); ///< barycentric
    Eigen::Vector3f point = Eigen::Vector3f::Zero();
    float squared = std::numeric_limits<float>::infinity(); ///< squared distance from the point asked for
};

/// Calls visit(triangle) for the other triangles around a corner of triangle `from`.
template <class Visit>
void visitAround(int from, int corner, const std::vector<Tri>& triangles, const std::vector<Tri>& across,
                 const Visit& visit) {
    // At a non-manifold vertex the way around may not come back to `from`.
    constexpr int most = 64;
    const int vertex = triangles[from][corner];
    // Around the one way, and from a rim on the other way.
    for (const int edge : {0, 2}) {
        int at = from;
        for (int i = 0; i < most; ++i) {
            int k = 0;
            while (triangles[at][k] != vertex) ++k;
            at = across[at][(k + edge) % 3];
            if (at == from) return;
            if (at < 0) break;
            visit(at);
        }
    }
}

/// Walks over a surface from a start triangle to the neighbour with the nearest point, until none is nearer
/// than the last: a local minimum of the distance to x. Points that are near through the solid or across a
/// fold are not reached, so that the result moves continuously with the surface. place(v): position of vertex
/// v.
template <class Place>
SurfacePoint walkDownhill(const Eigen::Vector3f& x, int start, const std::vector<Tri>& triangles,
                          const std::vector<Tri>& across, const Place& place, int steps) {
    SurfacePoint best;
    const auto visit = [&](int triangle) {
        const Tri& t = triangles[triangle];
        const Eigen::Vector3f a = place(t[0]), b = place(t[1]), c = place(t[2]);
        const Eigen::Vector3f w = nearestOnTriangle(x, a, b, c);
        const Eigen::Vector3f p = w[0] * a + w[1] * b + w[2] * c;
        const float d = (x - p).squaredNorm();
        if (d < best.squared) best = {triangle, w, p, d};
    };
    visit(start);
    int before = -1; // the triangle that the walk came from is farther
    for (int step = 0; step < steps; ++step) {
        const int from = best.triangle;
        const Tri& t = triangles[from];
        const Eigen::Vector3f w = best.weights, at = best.point, toX = x - at;
        // A triangle that the nearest point lies on has a nearer one only where a corner of it that is not
        // one of `from` lies towards x.
        const auto visitOther = [&](int triangle) {
            if (triangle == before) return;
            for (const int v : triangles[triangle])
                if (v != t[0] && v != t[1] && v != t[2] && toX.dot(place(v) - at) > 0) return visit(triangle);
        };
        // The distance can only decrease across an edge that the nearest point lies on, or at a corner to any
        // triangle around it.
        if ((w.array() > 0).count() == 1) {
            int corner = 0;
            w.maxCoeff(&corner);
            visitAround(from, corner, triangles, across, visitOther);
        } else {
            for (int k = 0; k < 3; ++k)
                if (w[(k + 2) % 3] <= 0 && across[from][k] >= 0) visitOther(across[from][k]);
        }
        if (best.triangle == from) break;
        before = from;
    }
    return best;
}

/// The triangle beyond each edge (k, k+1) of each triangle, -1 where there is none.
inline std::vector<Tri> trianglesAcross(const std::vector<Tri>& triangles) {
    std::map<std::pair<int, int>, int> sides;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
        for (int k = 0; k < 3; ++k) sides[{triangles[t][k], triangles[t][(k + 1) % 3]}] = t;
    std::vector<Tri> across(triangles.size(), Tri(-1, -1, -1));
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto other = sides.find({triangles[t][(k + 1) % 3], triangles[t][k]});
            if (other != sides.end()) across[t][k] = other->second;
        }
    return across;
}

} // namespace tss
