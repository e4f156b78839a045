#include "bake/respond/SkinRigParts.h"

#include <algorithm>
#include <limits>
#include <map>
#include <queue>

namespace tss::rig {
namespace {

/// Share of a constraint's own inverse mass that its compliance never goes below: with less the multipliers
/// of a sheet that is held in more ways than it can move creep (METHOD 6.3).
constexpr double complianceFloor = 0.01;

} // namespace

Rings rings(const TriangleMesh& mesh) {
    Rings result;
    result.ring.resize(mesh.vertices.size());
    result.rim.assign(mesh.vertices.size(), false);
    std::map<std::pair<int, int>, int> uses;
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (a != b) ++uses[std::minmax(a, b)];
        }
    for (const auto& [edge, count] : uses) {
        result.ring[edge.first].push_back(static_cast<std::uint32_t>(edge.second));
        result.ring[edge.second].push_back(static_cast<std::uint32_t>(edge.first));
        if (count != 2) result.rim[edge.first] = result.rim[edge.second] = true;
    }
    for (auto& ring : result.ring) std::sort(ring.begin(), ring.end());
    return result;
}

std::vector<double> edgeDistances(const TriangleMesh& skin, const Rings& rings,
                                  const std::vector<std::uint32_t>& sources, double limit) {
    std::vector<double> distance(skin.vertices.size(), std::numeric_limits<double>::infinity());
    using Item = std::pair<double, std::uint32_t>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> queue;
    for (const std::uint32_t v : sources) queue.push({distance[v] = 0, v});
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[v]) continue;
        for (const std::uint32_t w : rings.ring[v]) {
            const double through = d + (skin.vertices[v] - skin.vertices[w]).norm();
            if (through > limit || through >= distance[w]) continue;
            queue.push({distance[w] = through, w});
        }
    }
    return distance;
}

void addSheet(SkinRig& rig, const Rings& rings, const std::vector<std::uint32_t>& indexOf) {
    const auto count = static_cast<std::uint32_t>(rig.vertices.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto& ring = rings.ring[rig.vertices[i]];
        double ringMass = 0;
        bool whole = true;
        const auto first = static_cast<std::uint32_t>(rig.ring.size());
        for (const std::uint32_t neighbour : ring) {
            const std::uint32_t j = indexOf[neighbour];
            if (j >= count) {
                whole = false;
                continue;
            }
            rig.ring.push_back(j);
            ringMass += rig.inverseMass[j];
            const double mass = rig.inverseMass[i] + rig.inverseMass[j];
            const Vec3 d = rig.rest[i] - rig.rest[j];
            if (i > j || !(mass > 0) || !(d.norm() > 0)) continue;
            const double compliance = std::max(rig.parameters.stretchCompliance, complianceFloor * mass);
            rig.edges.push_back({i, j, d.normalized(), compliance});
        }
        // A rim has no Laplacian to speak of, and the vertices around the touched part do not move.
        if (!whole || rings.rim[rig.vertices[i]] || ring.empty() || !(rig.inverseMass[i] > 0)) {
            rig.ring.resize(first);
            continue;
        }
        const double n = static_cast<double>(ring.size());
        const double mass = rig.inverseMass[i] + ringMass / (n * n);
        const double compliance = std::max(rig.parameters.bendCompliance, complianceFloor * mass);
        rig.bends.push_back({i, first, static_cast<std::uint32_t>(rig.ring.size()), compliance, mass});
    }
}

} // namespace tss::rig
