#include "bake/geometry/Solid.h"

#include "bake/base/UnionFind.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/TrianglePoint.h"

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

/// Lower vertex, upper vertex, how much more often it is run through from the lower one than from the upper.
using EdgeUse = std::tuple<int, int, int>;

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

/// The ends of open edges, to find those at a place.
class OpenVertices {
public:
    OpenVertices(const TriangleMesh& mesh, const std::vector<OpenEdge>& open) : mesh_(mesh) {
        for (const OpenEdge& e : open) vertices_.insert(vertices_.end(), {e.from, e.to});
        std::sort(vertices_.begin(), vertices_.end());
        vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
        std::vector<Eigen::AlignedBox3d> boxes;
        for (const int v : vertices_) boxes.emplace_back(mesh.vertices[v]);
        tree_ = buildBvh(boxes);
    }

    /// For every vertex of the mesh the first of those that stand within `near` of it, or itself.
    std::vector<int> joined(double near) const {
        std::vector<int> place(mesh_.vertices.size());
        std::iota(place.begin(), place.end(), 0);
        for (const int v : vertices_)
            visitBall(tree_, mesh_.vertices[v], near, [&](std::uint32_t i) {
                const int other = vertices_[i];
                if ((mesh_.vertices[other] - mesh_.vertices[v]).norm() <= near)
                    place[v] = std::min(place[v], place[other]);
            });
        return place;
    }

    /// The vertices on the edge from its start to its end, both included.
    std::vector<int> along(const OpenEdge& edge, double near) const {
        const Vec3 &a = mesh_.vertices[edge.from], &b = mesh_.vertices[edge.to];
        const double length = (b - a).norm();
        std::vector<std::pair<double, int>> between;
        visitBall(tree_, 0.5 * (a + b), 0.5 * length + near, [&](std::uint32_t i) {
            const Vec3& p = mesh_.vertices[vertices_[i]];
            const double at = (p - a).dot(b - a) / length;
            if (at > near && at < length - near && (closestOnSegment(p, a, b) - p).norm() <= near)
                between.emplace_back(at, vertices_[i]);
        });
        std::sort(between.begin(), between.end());
        std::vector<int> chain{edge.from};
        for (const auto& [at, v] : between) chain.push_back(v);
        chain.push_back(edge.to);
        return chain;
    }

private:
    const TriangleMesh& mesh_;
    std::vector<int> vertices_;
    Bvh tree_;
};

/// How far apart edges may be and still be taken for one: what is a hundredth of an edge wide is no opening.
double seam(const TriangleMesh& mesh, const std::vector<OpenEdge>& open) {
    std::vector<double> lengths;
    lengths.reserve(open.size());
    for (const OpenEdge& e : open) lengths.push_back((mesh.vertices[e.to] - mesh.vertices[e.from]).norm());
    const auto middle = lengths.begin() + lengths.size() / 2;
    std::nth_element(lengths.begin(), middle, lengths.end());
    return std::max(0.01 * *middle, 1e-6 * diagonal(mesh));
}

std::vector<OpenEdge> openEdges(const TriangleMesh& mesh) {
    std::vector<EdgeUse> edges;
    for (const Tri& t : mesh.triangles) {
        // A segment or a point of surface bounds nothing, so that it has no opening either.
        if (hasZeroArea(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) continue;
        for (int k = 0; k < 3; ++k) edges.push_back(edgeUse(t[k], t[(k + 1) % 3], 1));
    }
    std::vector<OpenEdge> open = unbalanced(std::move(edges));
    if (open.empty()) return open;
    const double near = seam(mesh, open);
    // Vertices that stand at one place first, so that the ends of what is cut up next are single ones.
    const std::vector<int> place = OpenVertices(mesh, open).joined(near);
    edges.clear();
    for (const OpenEdge& e : open) edges.push_back(edgeUse(place[e.from], place[e.to], e.excess));
    open = unbalanced(std::move(edges));
    const OpenVertices ends(mesh, open);
    edges.clear();
    for (const OpenEdge& e : open) {
        const std::vector<int> chain = ends.along(e, near);
        for (std::size_t i = 1; i < chain.size(); ++i)
            edges.push_back(edgeUse(chain[i - 1], chain[i], e.excess));
    }
    return unbalanced(std::move(edges));
}

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& fans) {
    mesh.vertices = fans.vertices;
    mesh.triangles.insert(mesh.triangles.end(), fans.triangles.begin(), fans.triangles.end());
    return mesh;
}

std::string describe(const TriangleMesh& mesh, std::size_t open, bool hollow) {
    const MeshAudit audit = auditMesh(mesh);
    std::string s;
    if (hollow && open == 0)
        s = "the other body stands inside without touching: it counts as hollow, spheres cover its surface "
            "from both sides";
    else if (hollow)
        s = fmt::format("{} open or misoriented edges, and the other body stands inside without touching: it "
                        "counts as hollow, spheres cover its surface from both sides",
                        open);
    else if (open > 0)
        s = fmt::format("{} open or misoriented edges: their openings count as closed by flat fans", open);
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
    UnionFind together(mesh.vertices.size());
    for (const OpenEdge& e : open) together.join(e.from, e.to);
    struct Opening {
        std::vector<int> rim;
        int apex = -1;
    };
    std::map<std::size_t, Opening> openings; // by root, so that the order is the vertices' own
    for (const OpenEdge& e : open) {
        std::vector<int>& rim = openings[together.root(e.from)].rim;
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
            fans.triangles.emplace_back(e.to, e.from, openings[together.root(e.from)].apex);
    return fans;
}

Solid::Solid(const TriangleMesh& mesh, Interior interior)
    : mesh_((checkIndices(mesh), mesh)), hollow_(interior == Interior::Hollow),
      openEdges_(openEdges(mesh).size()),
      boundary_(hollow_ || openEdges_ == 0 ? mesh_ : joined(mesh, closingFans(mesh))),
      assumptions_(describe(mesh, openEdges_, hollow_)) {
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
