#pragma once
#include "bake/motion/Motion.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// Two neighbours of a skin.
struct SkinLink {
    std::uint32_t i = 0, j = 0;
    float shareI = 0, shareJ = 0; ///< of what is to be given up, 1 together; 0: fixed
};

/// x, y, z of a vertex and a fourth lane: one load.
using SkinPlace = Eigen::Vector4d;

/// The edges and triangles of a skin that may move, and which of them meet at each vertex. Immutable.
struct SkinWeave {
    std::vector<SkinLink> links;
    std::vector<double> squared; ///< #links: of the length at rest
    std::vector<Tri> triangles;
    std::vector<SkinPlace> normals; ///< #triangles at rest, twice the area long; fourth: the square of that
    std::vector<std::uint32_t> linkStart,
        linkOf; ///< of vertex v: linkOf[linkStart[v]] to linkOf[linkStart[v + 1]]
    std::vector<std::uint32_t> triangleStart, triangleOf;
};

/// inverseMass: of each vertex, 0 where it is fixed.
SkinWeave makeWeave(const std::vector<Vec3>& rest, const std::vector<Tri>& triangles,
                    const std::vector<float>& inverseMass);

/// How far a skin may be stretched and bent.
namespace strain {

constexpr double shortestEdge = 0.65, longestEdge = 1.5; ///< of its length at rest
constexpr double slack = 1e-3;      ///< of a limit, that an edge may be beyond it: it is only neared
constexpr double leastCosine = 0.1; ///< of a triangle's normal with itself at rest

constexpr double low2 = shortestEdge * shortestEdge, high2 = longestEdge * longestEdge;
constexpr double allowed2 = (1 - slack) * (1 - slack), beyond2 = (1 + slack) * (1 + slack);

/// now, squared: the squares of an edge's length now and at rest.
inline bool within(double now, double squared) {
    return now >= allowed2 * low2 * squared && now <= beyond2 * high2 * squared;
}

/// Whether a triangle is not turned over. now: its normal of any length; before: as SkinWeave::normals.
inline bool lies(const Vec3& now, const SkinPlace& before) {
    const double along = now.dot(before.head<3>());
    return along > 0 && along * along >= leastCosine * leastCosine * now.squaredNorm() * before[3];
}

} // namespace strain

inline Vec3 areaNormal(std::span<const Vec3> x, const Tri& t) {
    return (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]);
}

} // namespace tss
