#include "bake/respond/SkinWeave.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tss {
namespace {

void index(std::size_t vertices, std::size_t count, int corners, const auto& corner,
           std::vector<std::uint32_t>& start, std::vector<std::uint32_t>& of) {
    start.assign(vertices + 1, 0);
    for (std::size_t e = 0; e < count; ++e)
        for (int k = 0; k < corners; ++k) ++start[corner(e, k) + 1];
    for (std::size_t v = 0; v < vertices; ++v) start[v + 1] += start[v];
    of.resize(start.back());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (std::size_t e = 0; e < count; ++e)
        for (int k = 0; k < corners; ++k) of[next[corner(e, k)]++] = static_cast<std::uint32_t>(e);
}

} // namespace

SkinWeave makeWeave(const std::vector<Vec3>& rest, const std::vector<Tri>& triangles,
                    const std::vector<float>& inverseMass) {
    SkinWeave weave;
    std::map<std::pair<int, int>, bool> edges;
    for (const Tri& t : triangles) {
        if (!(inverseMass[t[0]] > 0) && !(inverseMass[t[1]] > 0) && !(inverseMass[t[2]] > 0)) continue;
        for (int k = 0; k < 3; ++k) edges[std::minmax(t[k], t[(k + 1) % 3])] = true;
        const Vec3 normal = areaNormal(rest, t);
        if (!(normal.squaredNorm() > 0)) continue;
        weave.triangles.push_back(t);
        weave.normals.emplace_back(normal.x(), normal.y(), normal.z(), normal.squaredNorm());
    }
    for (const auto& [edge, used] : edges) {
        const auto [i, j] = edge;
        const double squared = (rest[i] - rest[j]).squaredNorm();
        const float mass = inverseMass[i] + inverseMass[j];
        if (!(squared > 0) || !(mass > 0)) continue;
        weave.links.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j),
                               inverseMass[i] / mass, inverseMass[j] / mass});
        weave.squared.push_back(squared);
    }
    index(
        rest.size(), weave.links.size(), 2,
        [&](std::size_t e, int k) { return k == 0 ? weave.links[e].i : weave.links[e].j; }, weave.linkStart,
        weave.linkOf);
    index(
        rest.size(), weave.triangles.size(), 3,
        [&](std::size_t e, int k) { return static_cast<std::uint32_t>(weave.triangles[e][k]); },
        weave.triangleStart, weave.triangleOf);
    return weave;
}

} // namespace tss
