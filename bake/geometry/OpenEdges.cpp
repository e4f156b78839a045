#include "bake/geometry/OpenEdges.h"

#include "bake/base/UnionFind.h"

#include <algorithm>

namespace tss {

EdgeUse edgeUse(int from, int to, int times) {
    return {std::min(from, to), std::max(from, to), from < to ? times : -times};
}

std::vector<OpenEdge> unbalanced(std::vector<EdgeUse> edges) {
    std::sort(edges.begin(), edges.end());
    std::vector<OpenEdge> open;
    for (std::size_t i = 0; i < edges.size();) {
        const auto [a, b, ignored] = edges[i];
        int sum = 0;
        for (; i < edges.size() && std::get<0>(edges[i]) == a && std::get<1>(edges[i]) == b; ++i)
            sum += std::get<2>(edges[i]);
        if (sum > 0 && a != b) open.push_back({a, b, sum});
        if (sum < 0 && a != b) open.push_back({b, a, -sum});
    }
    return open;
}

std::vector<Tri> closingTriangles(const TriangleMesh& mesh) {
    std::vector<EdgeUse> edges;
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) edges.push_back(edgeUse(t[k], t[(k + 1) % 3], 1));
    const std::vector<OpenEdge> open = unbalanced(std::move(edges));
    if (open.empty()) return {};
    UnionFind together(mesh.vertices.size());
    for (const OpenEdge& e : open) together.join(e.from, e.to);
    std::vector<Tri> closing;
    for (const OpenEdge& e : open) {
        const auto apex = static_cast<int>(together.root(e.from));
        if (e.from != apex && e.to != apex)
            closing.insert(closing.end(), static_cast<std::size_t>(e.excess), Tri(e.to, e.from, apex));
    }
    return closing;
}

} // namespace tss
