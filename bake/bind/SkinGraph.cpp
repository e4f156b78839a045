#include "bake/bind/SkinGraph.h"

#include "bake/base/Order.h"

#include <algorithm>
#include <queue>

namespace tss {
namespace {

/// Cotangents are kept between these: below, the weight of an edge would no longer be positive; above, a
/// sliver would weld its corners together. Without a unit.
constexpr double leastCotangent = 1e-3, mostCotangent = 10;

constexpr int bitsAnAxis = 20;

/// Inserts two zero bits between each two bits.
std::uint64_t dilatedBits(std::uint64_t x) {
    std::uint64_t result = 0;
    for (int bit = 0; bit < bitsAnAxis; ++bit) result |= (x >> bit & 1) << (3 * bit);
    return result;
}

} // namespace

SkinGraph skinGraph(const TriangleMesh& skin) {
    SkinGraph graph;
    const std::size_t count = skin.vertices.size();
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    graph.area.assign(count, 0);
    double all = 0;
    for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
        const Tri& t = skin.triangles[i];
        const double third = skin.areaNormal(i).norm() / 6; // of the triangle's area
        all += 3 * third;
        for (int k = 0; k < 3; ++k) {
            graph.area[t[k]] += third;
            const auto a = static_cast<std::uint32_t>(t[k]), b = static_cast<std::uint32_t>(t[(k + 1) % 3]);
            if (a == b) continue;
            edges.emplace_back(a, b);
            edges.emplace_back(b, a);
        }
    }
    // A vertex without triangles, or with slivers only, still needs some mass in linear systems.
    const double least = count > 0 ? std::max(1e-2 * all / static_cast<double>(count), 1e-300) : 0;
    for (double& a : graph.area) a = std::max(a, least);
    sortOnce(edges);
    auto edge = edges.begin();
    for (std::uint32_t v = 0; v < count; ++v) {
        for (; edge != edges.end() && edge->first == v; ++edge) {
            const double length = (skin.vertices[v] - skin.vertices[edge->second]).norm();
            graph.edges.push_back({edge->second, length});
            graph.meanEdge += length / static_cast<double>(edges.size());
        }
        graph.edges.endList();
    }
    return graph;
}

std::vector<std::uint32_t> lowerDistances(const SkinGraph& graph, std::span<const std::uint32_t> sources,
                                          double limit, std::vector<double>& distance,
                                          std::span<const double> starts) {
    std::vector<std::uint32_t> lowered;
    using Item = std::pair<double, std::uint32_t>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    for (std::size_t i = 0; i < sources.size(); ++i) {
        const double start = starts.empty() ? 0 : starts[i];
        if (start < distance[sources[i]]) queue.push({distance[sources[i]] = start, sources[i]});
    }
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v]) continue;
        lowered.push_back(v);
        for (const auto& [w, length] : graph.edges[v]) {
            const double through = d + length;
            if (through > limit || through >= distance[w]) continue;
            queue.push({distance[w] = through, w});
        }
    }
    return lowered;
}

SparseMatrix skinLaplacian(const TriangleMesh& skin, std::span<const double> stiffness) {
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(12 * skin.triangles.size());
    for (std::size_t i = 0; i < skin.triangles.size(); ++i) {
        const Tri& t = skin.triangles[i];
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
            const Vec3 u = skin.vertices[a] - skin.vertices[c], v = skin.vertices[b] - skin.vertices[c];
            const double sine = u.cross(v).norm(), cosine = u.dot(v);
            double weight = sine > 0 ? cosine / sine / 2 : mostCotangent;
            weight = std::clamp(weight, leastCotangent, mostCotangent);
            if (!stiffness.empty()) weight *= stiffness[i];
            entries.emplace_back(a, b, -weight);
            entries.emplace_back(b, a, -weight);
            entries.emplace_back(a, a, weight);
            entries.emplace_back(b, b, weight);
        }
    }
    const auto count = static_cast<Eigen::Index>(skin.vertices.size());
    SparseMatrix laplacian(count, count);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    return laplacian;
}

std::vector<std::uint32_t> alongCurve(const std::vector<Vec3>& points) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : points) box.extend(p);
    const double size = points.empty() ? 0 : box.sizes().maxCoeff();
    const double scale = size > 0 ? ((1 << bitsAnAxis) - 1) / size : 0;
    std::vector<std::uint64_t> code;
    for (const Vec3& p : points) {
        const Vec3 cell = scale * (p - box.min());
        std::uint64_t bits = 0;
        for (int k = 0; k < 3; ++k) bits |= dilatedBits(static_cast<std::uint64_t>(cell[k])) << k;
        code.push_back(bits);
    }
    std::vector<std::uint32_t> order = indicesOf(points.size());
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return code[a] < code[b]; });
    return order;
}

} // namespace tss
