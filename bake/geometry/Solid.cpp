#include "bake/geometry/Solid.h"

#include "bake/geometry/MeshAudit.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace tss {

namespace {

/// A directed edge that triangles run through `excess` times more often than its reverse.
struct OpenEdge {
    int from, to, excess;
};

std::vector<OpenEdge> openEdges(const TriangleMesh& mesh) {
    std::vector<std::tuple<int, int, int>> edges; // lower vertex, upper vertex, +1 or -1
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b), a < b ? 1 : -1);
        }
    std::sort(edges.begin(), edges.end());
    std::vector<OpenEdge> open;
    for (std::size_t i = 0; i < edges.size();) {
        const auto [a, b, ignored] = edges[i];
        int sum = 0;
        for (; i < edges.size() && std::get<0>(edges[i]) == a && std::get<1>(edges[i]) == b; ++i)
            sum += std::get<2>(edges[i]);
        if (sum > 0) open.push_back({a, b, sum});
        if (sum < 0) open.push_back({b, a, -sum});
    }
    return open;
}

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& fans) {
    mesh.vertices = fans.vertices;
    mesh.triangles.insert(mesh.triangles.end(), fans.triangles.begin(), fans.triangles.end());
    return mesh;
}

std::string describe(const TriangleMesh& mesh) {
    const std::vector<OpenEdge> open = openEdges(mesh);
    const MeshAudit audit = auditMesh(mesh);
    std::string s;
    if (!open.empty())
        s = fmt::format("{} open or misoriented edges: their openings count as closed by flat fans",
                        open.size());
    else if (audit.insideOut())
        s = "inside out: the inside is where the winding number is not 0, whatever its sign";
    else if (audit.nonManifoldEdges > 0)
        s = fmt::format("{} non-manifold edges: the inside is where the winding number is not 0",
                        audit.nonManifoldEdges);
    return s;
}

} // namespace

TriangleMesh closingFans(const TriangleMesh& mesh) {
    const std::vector<OpenEdge> open = openEdges(mesh);
    std::vector<int> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](int v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    for (const OpenEdge& e : open) {
        const int a = root(e.from), b = root(e.to);
        parent[std::max(a, b)] = std::min(a, b);
    }
    struct Opening {
        std::vector<int> rim;
        int apex = -1;
    };
    std::map<int, Opening> openings; // by root, so that the order is the vertices' own
    for (const OpenEdge& e : open) {
        std::vector<int>& rim = openings[root(e.from)].rim;
        rim.insert(rim.end(), {e.from, e.to});
    }
    TriangleMesh fans;
    fans.vertices = mesh.vertices;
    for (auto& [ignored, opening] : openings) {
        std::sort(opening.rim.begin(), opening.rim.end());
        opening.rim.erase(std::unique(opening.rim.begin(), opening.rim.end()), opening.rim.end());
        const Vec3 origin = mesh.vertices[opening.rim[0]];
        Vec3 mean = Vec3::Zero();
        for (const int v : opening.rim) mean += mesh.vertices[v] - origin;
        opening.apex = static_cast<int>(fans.vertices.size());
        fans.vertices.emplace_back(origin + mean / static_cast<double>(opening.rim.size()));
    }
    for (const OpenEdge& e : open)
        for (int i = 0; i < e.excess; ++i)
            fans.triangles.emplace_back(e.to, e.from, openings[root(e.from)].apex);
    return fans;
}

Solid::Solid(const TriangleMesh& mesh)
    : mesh_((checkIndices(mesh), mesh)), boundary_(joined(mesh, closingFans(mesh))),
      assumptions_(describe(mesh)) {
    const Eigen::AlignedBox3d box = bounds(mesh);
    if (!box.isEmpty()) diagonal_ = box.diagonal().norm();
}

double Solid::protrusion(const Vec3& centre, double radius) const {
    const double distance = boundary_.distance(centre);
    // On the surface the side makes no difference, and is the one thing that is slow to tell.
    const bool out = distance <= 1e-9 * radius || !inside(centre);
    return std::max(0.0, out ? radius + distance : radius - distance);
}

} // namespace tss
