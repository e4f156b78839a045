#include "bake/respond/SkinRigParts.h"

#include <algorithm>
#include <cmath>
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
    result.rim.resize(mesh.vertices.size());
    std::map<std::pair<int, int>, int> uses;
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (a != b) ++uses[std::minmax(a, b)];
        }
    for (const auto& [edge, count] : uses) {
        result.ring[edge.first].push_back(static_cast<std::uint32_t>(edge.second));
        result.ring[edge.second].push_back(static_cast<std::uint32_t>(edge.first));
        if (count == 2) continue;
        result.rim[edge.first].push_back(static_cast<std::uint32_t>(edge.second));
        result.rim[edge.second].push_back(static_cast<std::uint32_t>(edge.first));
    }
    for (auto* rings : {&result.ring, &result.rim})
        for (auto& ring : *rings) std::sort(ring.begin(), ring.end());
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

SheetPatch patchAround(const SkinRig& rig, const TriangleMesh& skin, const Rings& rings,
                       const std::vector<std::uint32_t>& touched, double reach) {
    std::vector<std::uint32_t> sources;
    for (const std::uint32_t v : touched) sources.push_back(rig.vertices[v]);
    const std::vector<double> distances = edgeDistances(skin, rings, sources, reach);
    std::vector<bool> inside;
    for (const std::uint32_t v : rig.vertices) inside.push_back(std::isfinite(distances[v]));
    return patchOf(rig.sheet, inside);
}

void addSheet(SkinRig& rig, const Rings& rings, const std::vector<std::uint32_t>& indexOf) {
    const auto count = static_cast<std::uint32_t>(rig.vertices.size());
    const auto compliance = [](double asked, double mass) {
        // Beyond the largest float a constraint has no effect anyway.
        return static_cast<float>(std::min(std::max(asked, complianceFloor * mass), 1e30));
    };
    SkinSheet& sheet = rig.sheet;
    const std::vector<float>& w = sheet.inverseMass;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto& ring = rings.ring[rig.vertices[i]];
        bool whole = true;
        const auto first = static_cast<std::uint32_t>(sheet.ring.size());
        for (const std::uint32_t neighbour : ring) {
            const std::uint32_t j = indexOf[neighbour];
            if (j >= count) {
                whole = false;
                continue;
            }
            sheet.ring.push_back(j);
            const float mass = w[i] + w[j];
            const Vec3 d = rig.rest[i] - rig.rest[j];
            if (i > j || !(mass > 0) || !(d.norm() > 0)) continue;
            SheetEdge edge;
            edge.direction.head<3>() = d.normalized().cast<float>();
            edge.direction[3] = 0;
            edge.i = i;
            edge.j = j;
            edge.compliance = compliance(rig.parameters.stretchCompliance, mass);
            edge.inverse = 1 / (mass + edge.compliance);
            sheet.edges.push_back(edge);
        }
        // A rim bends along itself; where rims meet there is no Laplacian to speak of, and the vertices
        // around the touched part do not move.
        const auto& rim = rings.rim[rig.vertices[i]];
        if (!whole || (!rim.empty() && rim.size() != 2) || ring.empty() || !(w[i] > 0)) {
            sheet.ring.resize(first);
            continue;
        }
        if (rim.empty()) {
            sheet.ringShare.resize(sheet.ring.size(), 1.0f / static_cast<float>(ring.size()));
        } else {
            // Weighted by nearness: what is uneven along a cut is its spacing, not its motion.
            sheet.ring.resize(first);
            for (const int k : {0, 1}) {
                const double near = (rig.rest[indexOf[rim[k]]] - rig.rest[i]).norm(),
                             far = (rig.rest[indexOf[rim[1 - k]]] - rig.rest[i]).norm();
                sheet.ring.push_back(indexOf[rim[k]]);
                sheet.ringShare.push_back(near + far > 0 ? static_cast<float>(far / (near + far)) : 0.5f);
            }
        }
        SheetBend bend;
        bend.centre = i;
        bend.first = first;
        bend.last = static_cast<std::uint32_t>(sheet.ring.size());
        float mass = w[i];
        for (std::uint32_t k = first; k < bend.last; ++k)
            mass += w[sheet.ring[k]] * sheet.ringShare[k] * sheet.ringShare[k];
        bend.compliance = compliance(rig.parameters.bendCompliance, mass);
        bend.inverse = 1 / (mass + bend.compliance);
        sheet.bends.push_back(bend);
    }
}

} // namespace tss::rig
