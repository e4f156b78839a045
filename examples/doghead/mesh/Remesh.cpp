// After Botsch and Kobbelt, "A remeshing approach to multiresolution modeling", 2004.
#include "examples/doghead/mesh/Meshing.h"

#include "bake/base/Parallel.h"
#include "examples/doghead/mesh/EditableMesh.h"
#include "examples/doghead/mesh/SizeField.h"

#include <algorithm>
#include <cmath>

namespace doghead {
namespace {

/// Newton steps along the gradient onto the surface, none longer than half a `reach`, so that a vertex cannot
/// jump to another sheet.
Vec3 onSurface(const Field& field, Vec3 p, double reach) {
    for (int i = 0; i < 4; ++i) {
        const double d = field(p);
        if (std::abs(d) < 1e-4) break;
        Vec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            Vec3 q = p;
            q[axis] += 0.02;
            gradient[axis] = (field(q) - d) / 0.02;
        }
        Vec3 step = -d / std::max(gradient.squaredNorm(), 0.25) * gradient;
        if (step.norm() > reach / 2) step *= reach / 2 / step.norm();
        p += step;
    }
    return p;
}

class Remesher {
public:
    Remesher(const tss::TriangleMesh& raw, const Field& field, const RemeshOptions& options)
        : mesh_(raw), field_(field), size_(raw, field, options) {}

    void round() {
        splitLong();
        collapseShort();
        flipEdges();
        smooth();
    }
    void removeNeedles();
    tss::TriangleMesh result() const { return mesh_.mesh(); }

private:
    double length(int a, int b) const { return (mesh_.vertices[a] - mesh_.vertices[b]).norm(); }
    Vec3 middle(int a, int b) const { return (mesh_.vertices[a] + mesh_.vertices[b]) / 2; }
    double qualityOf(int triangle) const {
        const Tri& t = mesh_.triangles[triangle];
        return quality(mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]);
    }

    void splitLong();
    void collapseShort();
    void flipEdges();
    void smooth();
    void removePyramids();

    EditableMesh mesh_;
    const Field& field_;
    SizeField size_;
};

void Remesher::splitLong() {
    for (EditableMesh::Edge edge : mesh_.edges()) {
        const double wanted = size_(middle(edge.a, edge.b));
        if (length(edge.a, edge.b) <= wanted * 4 / 3 || !mesh_.find(edge.a, edge.b, edge)) continue;
        const Vec3 at = onSurface(field_, middle(edge.a, edge.b), wanted / 2);
        // An edge across a gap that the raw mesh bridged has no surface under its middle.
        if ((at - middle(edge.a, edge.b)).norm() < 0.3 * length(edge.a, edge.b)) mesh_.split(edge, at);
    }
}

void Remesher::collapseShort() {
    for (EditableMesh::Edge edge : mesh_.edges()) {
        if (mesh_.around[edge.a].empty() || mesh_.around[edge.b].empty()) continue;
        const double wanted = size_(middle(edge.a, edge.b));
        if (length(edge.a, edge.b) >= wanted * 4 / 5 || !mesh_.find(edge.a, edge.b, edge)) continue;
        mesh_.collapse(edge, onSurface(field_, middle(edge.a, edge.b), wanted), wanted * 4 / 3);
    }
}

void Remesher::flipEdges() {
    for (EditableMesh::Edge edge : mesh_.edges()) {
        if (!mesh_.find(edge.a, edge.b, edge)) continue;
        mesh_.flip(edge, 1.02 * std::min(qualityOf(edge.left), qualityOf(edge.right)));
    }
}

void Remesher::smooth() {
    std::vector<Vec3> target(mesh_.vertices.size());
    tss::parallelFor(mesh_.vertices.size(), [&](std::size_t i) {
        if (mesh_.around[i].empty()) return;
        const Vec3& here = mesh_.vertices[i];
        Vec3 sum = Vec3::Zero();
        double weights = 0;
        for (int t : mesh_.around[i]) {
            Vec3 centre = Vec3::Zero();
            for (int k = 0; k < 3; ++k) centre += mesh_.vertices[mesh_.triangles[t][k]] / 3;
            // Equal numbers of triangles in places that ask for different sizes: area over the size squared.
            const double size = size_(centre), weight = mesh_.areaNormal(t).norm() / (size * size);
            sum += weight * centre;
            weights += weight;
        }
        if (weights <= 0) return void(target[i] = here);
        const Vec3 move = 0.7 * (sum / weights - here), n = normal(field_, here);
        target[i] = onSurface(field_, here + move - n.dot(move) * n, size_(here));
    });
    // Moves that would turn a triangle over are left out; one after the other, for each sees those before it.
    for (std::size_t i = 0; i < target.size(); ++i) {
        if (mesh_.around[i].empty()) continue;
        const Vec3 before = mesh_.vertices[i];
        std::vector<Vec3> normals;
        double worstBefore = 1, worstAfter = 1;
        for (int t : mesh_.around[i]) {
            normals.push_back(mesh_.areaNormal(t));
            worstBefore = std::min(worstBefore, qualityOf(t));
        }
        mesh_.vertices[i] = target[i];
        bool turned = false;
        for (std::size_t k = 0; k < normals.size(); ++k) {
            const Vec3 n = mesh_.areaNormal(mesh_.around[i][k]);
            turned |= n.dot(normals[k]) < 0.5 * n.norm() * normals[k].norm();
            worstAfter = std::min(worstAfter, qualityOf(mesh_.around[i][k]));
        }
        if (turned || worstAfter < std::min(worstBefore, 0.3)) mesh_.vertices[i] = before;
    }
}

/// A vertex with three triangles is drawn into a neighbour, which leaves one triangle in their place.
void Remesher::removePyramids() {
    for (int v = 0; v < int(mesh_.vertices.size()); ++v) {
        if (mesh_.around[v].size() != 3) continue;
        EditableMesh::Edge edge;
        for (int neighbour : mesh_.neighbours(v)) {
            const Vec3 at = mesh_.vertices[neighbour], facing = normal(field_, at);
            if (mesh_.find(neighbour, v, edge) && mesh_.collapse(edge, at, 1e9, &facing)) break;
        }
    }
}

void Remesher::removeNeedles() {
    for (int pass = 0; pass < 6; ++pass) {
        int left = 0;
        removePyramids();
        for (int t = 0; t < int(mesh_.triangles.size()); ++t) {
            if (mesh_.triangles[t][0] < 0 || qualityOf(t) > 0.35) continue;
            ++left;
            const Tri corner = mesh_.triangles[t];
            int shortest = 0, longest = 0;
            for (int k = 1; k < 3; ++k) {
                if (length(corner[k], corner[(k + 1) % 3]) <
                    length(corner[shortest], corner[(shortest + 1) % 3]))
                    shortest = k;
                if (length(corner[k], corner[(k + 1) % 3]) >
                    length(corner[longest], corner[(longest + 1) % 3]))
                    longest = k;
            }
            EditableMesh::Edge edge;
            if (mesh_.find(corner[longest], corner[(longest + 1) % 3], edge)) {
                const double worst = std::min(qualityOf(edge.left), qualityOf(edge.right));
                if (mesh_.flip(edge, worst + 0.02)) continue;
            }
            const int a = corner[shortest], b = corner[(shortest + 1) % 3];
            if (!mesh_.find(a, b, edge)) continue;
            const Vec3 at = onSurface(field_, middle(a, b), 1), facing = normal(field_, at);
            if (!mesh_.collapse(edge, at, 1e9)) mesh_.collapse(edge, at, 1e9, &facing);
        }
        if (left == 0) return;
        smooth();
    }
}

} // namespace

tss::TriangleMesh remesh(const tss::TriangleMesh& raw, const Field& field, const RemeshOptions& options) {
    Remesher remesher(raw, field, options);
    for (int i = 0; i < options.rounds; ++i) remesher.round();
    remesher.removeNeedles();
    return remesher.result();
}

} // namespace doghead
