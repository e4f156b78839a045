#include "bake/geometry/Solid.h"

#include "bake/base/Order.h"
#include "bake/base/UnionFind.h"
#include "bake/geometry/MeshAudit.h"
#include "bake/geometry/OpenEdges.h"
#include "bake/geometry/TriangleDistance.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace tss {

namespace {

/// Vertices nearer to each other than this share of the mesh's diagonal count as one.
constexpr double weldShare = 1e-6;
/// A gap along an edge narrower than this share of the edge's length is a crack, not a hole.
constexpr double crackShare = 0.01;

/// The end vertices of open edges, in a tree: finds those near a vertex and those along an edge.
class OpenVertices {
public:
    /// least: vertices nearer to each other than this count as one, scene units.
    OpenVertices(const TriangleMesh& mesh, const std::vector<OpenEdge>& open, double least) : mesh_(mesh) {
        std::map<int, double> shortest;
        for (const OpenEdge& e : open)
            for (const int v : {e.from, e.to}) {
                const double length = (mesh.vertices[e.to] - mesh.vertices[e.from]).norm();
                double& own = shortest.try_emplace(v, length).first->second;
                own = std::min(own, length);
            }
        std::vector<Eigen::AlignedBox3d> boxes;
        for (const auto& [v, length] : shortest) {
            vertices_.push_back(v);
            near_.push_back(std::max(least, crackShare * length));
            boxes.emplace_back(mesh.vertices[v]);
        }
        tree_ = buildBvh(boxes);
    }

    /// For every vertex of the mesh the one of lowest index among those that count as one with it, also
    /// across a crack; itself where there is none.
    std::vector<int> representatives() const {
        std::vector<int> place = indicesOf<int>(mesh_.vertices.size());
        for (std::size_t k = 0; k < vertices_.size(); ++k) {
            const int v = vertices_[k];
            visitBall(tree_, mesh_.vertices[v], near_[k], [&](std::uint32_t i) {
                const int other = vertices_[i];
                // Not transitive: a rim of many short edges must not collapse into one point.
                if ((mesh_.vertices[other] - mesh_.vertices[v]).norm() <= std::min(near_[k], near_[i]))
                    place[v] = std::min(place[v], other);
            });
        }
        return place;
    }

    /// The vertices on the edge from its start to its end, both included.
    std::vector<int> along(const OpenEdge& edge, double least) const {
        const Vec3 &a = mesh_.vertices[edge.from], &b = mesh_.vertices[edge.to];
        const double length = (b - a).norm(), near = std::max(least, crackShare * length);
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
    std::vector<double> near_; ///< distance within which another vertex counts as one with each
    Bvh tree_;
};

/// The openings of a mesh: edges on the rims of holes, and strips of triangles that close cracks.
struct Openings {
    std::vector<OpenEdge> rims;
    std::vector<Tri> strips;
    double widest = 0; ///< width of the widest crack, scene units; 0 where all are below weldShare
};

/// The edges of all triangles but those without area, segments or points, which bound nothing and have no
/// opening either.
std::vector<EdgeUse> usedEdges(const TriangleMesh& mesh) {
    std::vector<EdgeUse> edges;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (hasZeroArea(mesh, i)) continue;
        const Tri& t = mesh.triangles[i];
        for (int k = 0; k < 3; ++k) edges.push_back(edgeUse(t[k], t[(k + 1) % 3], 1));
    }
    return edges;
}

class FindOpenings {
public:
    explicit FindOpenings(const TriangleMesh& mesh) : mesh_(mesh), least_(weldShare * diagonal(mesh)) {}

    Openings run() {
        found_.rims = unbalanced(usedEdges(mesh_));
        if (found_.rims.empty()) return std::move(found_);
        // First vertices that count as one are joined, so that the edges divided next have unique ends.
        const std::vector<int> place = OpenVertices(mesh_, found_.rims, least_).representatives();
        replace([&](const OpenEdge& e) { return std::vector{e.from, place[e.from], place[e.to], e.to}; }, 1);
        const OpenVertices ends(mesh_, found_.rims, least_);
        replace([&](const OpenEdge& e) { return ends.along(e, least_); }, 0);
        if (!(found_.widest > least_)) { // no crack wider than rounding
            found_.widest = 0;
            found_.strips.clear();
        }
        return std::move(found_);
    }

private:
    /// Replaces each open edge by a polyline between its ends, without the first and last `skipped` segments,
    /// which the neighbouring edges have too. A strip closes what lies between edge and polyline.
    template <class PolylineOf>
    void replace(const PolylineOf& polylineOf, std::size_t skipped) {
        std::vector<EdgeUse> edges;
        for (const OpenEdge& e : found_.rims) {
            const std::vector<int> line = polylineOf(e);
            for (std::size_t i = 1 + skipped; i + skipped < line.size(); ++i)
                edges.push_back(edgeUse(line[i - 1], line[i], e.excess));
            addStrip(e, line);
        }
        found_.rims = unbalanced(std::move(edges));
    }

    void addStrip(const OpenEdge& e, const std::vector<int>& line) {
        const Vec3 &a = mesh_.vertices[e.from], &b = mesh_.vertices[e.to];
        for (std::size_t i = 1; i + 1 < line.size(); ++i) {
            const Vec3& p = mesh_.vertices[line[i]];
            found_.widest = std::max(found_.widest, (closestOnSegment(p, a, b) - p).norm());
            if (const Tri t(e.to, line[i - 1], line[i]); t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
                found_.strips.insert(found_.strips.end(), static_cast<std::size_t>(e.excess), t);
        }
    }

    const TriangleMesh& mesh_;
    double least_;
    Openings found_;
};

TriangleMesh joined(TriangleMesh mesh, const TriangleMesh& fans) {
    mesh.vertices = fans.vertices;
    mesh.triangles.insert(mesh.triangles.end(), fans.triangles.begin(), fans.triangles.end());
    return mesh;
}

std::string describe(const TriangleMesh& mesh, const Openings& openings, bool hollow) {
    const MeshAudit audit = auditMesh(mesh);
    const std::size_t open = openings.rims.size();
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
    else if (openings.widest > 0)
        s = fmt::format("cracks, up to {:.3g} scene units wide, count as closed", openings.widest);
    else if (audit.insideOut())
        s = "inside out: the inside is where the winding number is not 0, whatever its sign";
    else if (audit.turnedOverTriangles > 0)
        s = fmt::format("{} triangles are given a second time turned over and bound nothing: the inside is "
                        "where the winding number is not 0",
                        audit.turnedOverTriangles);
    else if (audit.nonManifoldEdges > 0)
        s = fmt::format("{} non-manifold edges: the inside is where the winding number is not 0",
                        audit.nonManifoldEdges);
    return s;
}

/// Triangles that close the openings of a mesh: over each connected set of edges that triangles do not run
/// through equally often in both directions, a cone to the mean of its vertices. With them every mesh, also a
/// misoriented or non-manifold one and a soup of triangles, has an integer winding number off its surface.
/// Edges that lie on each other to 1e-6 of the mesh's diagonal are no opening, whether or not they share
/// vertices: seams that were not welded, T-junctions. Between those that do to a hundredth of their own
/// length, cracks, are strips in place of a cone. Vertices of the mesh first, one apex an opening after them;
/// the triangles are the fans' alone.
TriangleMesh closingFans(const TriangleMesh& mesh, const Openings& openings) {
    UnionFind together(mesh.vertices.size());
    for (const OpenEdge& e : openings.rims) together.join(e.from, e.to);
    struct Opening {
        std::vector<int> rim;
        int apex = -1;
    };
    std::map<std::size_t, Opening> holes; // by root, so that the order is the vertices' own
    for (const OpenEdge& e : openings.rims) {
        std::vector<int>& rim = holes[together.root(e.from)].rim;
        rim.insert(rim.end(), {e.from, e.to});
    }
    TriangleMesh fans;
    fans.vertices = mesh.vertices;
    fans.triangles = openings.strips;
    for (auto& [ignored, hole] : holes) {
        sortOnce(hole.rim);
        const Vec3 origin = mesh.vertices[hole.rim[0]];
        Vec3 mean = Vec3::Zero();
        for (const int v : hole.rim) mean += mesh.vertices[v] - origin;
        hole.apex = static_cast<int>(fans.vertices.size());
        fans.vertices.emplace_back(origin + mean / static_cast<double>(hole.rim.size()));
    }
    for (const OpenEdge& e : openings.rims)
        for (int i = 0; i < e.excess; ++i)
            fans.triangles.emplace_back(e.to, e.from, holes[together.root(e.from)].apex);
    return fans;
}

/// Triangles with an area run through every edge equally often in both directions.
bool isClosed(const TriangleMesh& mesh) {
    return unbalanced(usedEdges(mesh)).empty();
}

} // namespace

Solid::Solid(const TriangleMesh& mesh, Interior interior)
    : mesh_((checkIndices(mesh), mesh)), hollow_(interior == Interior::Hollow), boundary_(TriangleMesh()) {
    const Openings openings = FindOpenings(mesh).run();
    open_ = !openings.rims.empty() || openings.widest > 0;
    const TriangleMesh boundary = hollow_ || !open_ ? mesh_ : joined(mesh_, closingFans(mesh_, openings));
    boundary_ = MeshQuery(boundary, !hollow_ && isClosed(boundary));
    assumptions_ = describe(mesh_, openings, hollow_);
    const Eigen::AlignedBox3d box = bounds(mesh_);
    if (!box.isEmpty()) diagonal_ = box.diagonal().norm();
}

double Solid::protrusion(const Vec3& centre, double radius) const {
    const double distance = boundary_.distance(centre);
    // On the surface both formulas agree, and the winding number, which is slow, is not needed.
    const bool out = distance <= 1e-9 * radius || !inside(centre);
    return std::max(0.0, out ? radius + distance : radius - distance);
}

} // namespace tss
