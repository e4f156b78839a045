#include "examples/doghead/mesh/EditableMesh.h"

#include <algorithm>
#include <cmath>

namespace doghead {
namespace {

void removeOne(std::vector<int>& list, int value) {
    list.erase(std::find(list.begin(), list.end(), value));
}

} // namespace

double quality(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return squares > 0 ? 2 * std::sqrt(3.) * (b - a).cross(c - a).norm() / squares : 0;
}

EditableMesh::EditableMesh(const tss::TriangleMesh& mesh)
    : vertices(mesh.vertices), triangles(mesh.triangles), around(mesh.vertices.size()) {
    for (int t = 0; t < int(triangles.size()); ++t)
        for (int k = 0; k < 3; ++k) around[triangles[t][k]].push_back(t);
}

tss::TriangleMesh EditableMesh::mesh() const {
    tss::TriangleMesh result;
    std::vector<int> index(vertices.size(), -1);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        if (!around[i].empty()) {
            index[i] = int(result.vertices.size());
            result.vertices.push_back(vertices[i]);
        }
    for (const Tri& t : triangles)
        if (t[0] >= 0) result.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
    return result;
}

std::vector<EditableMesh::Edge> EditableMesh::edges() const {
    std::vector<Edge> result;
    Edge edge;
    for (const Tri& t : triangles)
        for (int k = 0; k < 3 && t[0] >= 0; ++k)
            if (t[k] < t[(k + 1) % 3] && find(t[k], t[(k + 1) % 3], edge)) result.push_back(edge);
    return result;
}

bool EditableMesh::find(int a, int b, Edge& edge) const {
    edge = {a, b, -1, -1};
    for (int t : around[a])
        for (int k = 0; k < 3; ++k) {
            if (triangles[t][k] == a && triangles[t][(k + 1) % 3] == b) edge.left = t;
            if (triangles[t][k] == b && triangles[t][(k + 1) % 3] == a) edge.right = t;
        }
    return edge.left >= 0 && edge.right >= 0;
}

int EditableMesh::opposite(int triangle, int a, int b) const {
    const Tri& t = triangles[triangle];
    return t[0] + t[1] + t[2] - a - b;
}

Vec3 EditableMesh::areaNormal(int triangle) const {
    const Tri& t = triangles[triangle];
    return (vertices[t[1]] - vertices[t[0]]).cross(vertices[t[2]] - vertices[t[0]]);
}

std::vector<int> EditableMesh::neighbours(int vertex) const {
    std::vector<int> ring;
    for (int t : around[vertex])
        for (int k = 0; k < 3; ++k)
            if (triangles[t][k] != vertex) ring.push_back(triangles[t][k]);
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    return ring;
}

void EditableMesh::dropTriangle(int triangle) {
    for (int k = 0; k < 3; ++k) removeOne(around[triangles[triangle][k]], triangle);
    triangles[triangle] = {-1, -1, -1};
}

int EditableMesh::split(const Edge& edge, const Vec3& at) {
    const int middle = int(vertices.size());
    vertices.push_back(at);
    around.emplace_back();
    for (const int t : {edge.left, edge.right}) {
        // The half at b becomes a triangle of its own, the half at a stays.
        Tri half = triangles[t];
        for (int k = 0; k < 3; ++k) {
            if (half[k] == edge.a) half[k] = middle;
            if (triangles[t][k] == edge.b) triangles[t][k] = middle;
        }
        const int added = int(triangles.size());
        triangles.push_back(half);
        removeOne(around[edge.b], t);
        around[middle].push_back(t);
        for (int k = 0; k < 3; ++k) around[half[k]].push_back(added);
    }
    return middle;
}

bool EditableMesh::turnsOver(int vertex, const Vec3& at, const Edge& except, const Vec3* facing) const {
    for (int t : around[vertex]) {
        if (t == except.left || t == except.right) continue;
        Vec3 corner[3];
        for (int k = 0; k < 3; ++k) corner[k] = triangles[t][k] == vertex ? at : vertices[triangles[t][k]];
        const Vec3 before = facing ? *facing : areaNormal(t);
        const Vec3 after = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        // 75 degrees at most, and no needle that was none before
        if (after.dot(before) < 0.26 * after.norm() * before.norm()) return true;
        const Tri& i = triangles[t];
        const double now = quality(vertices[i[0]], vertices[i[1]], vertices[i[2]]);
        if (quality(corner[0], corner[1], corner[2]) < std::min(0.2, now)) return true;
    }
    return false;
}

bool EditableMesh::collapse(const Edge& edge, const Vec3& at, double longest, const Vec3* facing) {
    const std::vector<int> ringA = neighbours(edge.a), ringB = neighbours(edge.b);
    std::vector<int> shared;
    std::set_intersection(ringA.begin(), ringA.end(), ringB.begin(), ringB.end(), std::back_inserter(shared));
    if (shared.size() != 2) return false; // the link condition: else two sheets would be joined
    for (int v : shared)
        if (around[v].size() <= 3) return false;
    for (const auto* ring : {&ringA, &ringB})
        for (int v : *ring)
            if (v != edge.a && v != edge.b && (vertices[v] - at).norm() > longest) return false;
    if (turnsOver(edge.a, at, edge, facing) || turnsOver(edge.b, at, edge, facing)) return false;

    dropTriangle(edge.left);
    dropTriangle(edge.right);
    for (int t : around[edge.b]) {
        for (int k = 0; k < 3; ++k)
            if (triangles[t][k] == edge.b) triangles[t][k] = edge.a;
        around[edge.a].push_back(t);
    }
    around[edge.b].clear();
    vertices[edge.a] = at;
    return true;
}

bool EditableMesh::flip(const Edge& edge, double leastQuality) {
    const int c = opposite(edge.left, edge.a, edge.b), d = opposite(edge.right, edge.a, edge.b);
    Edge exists;
    if (c == d || find(c, d, exists) || around[edge.a].size() <= 3 || around[edge.b].size() <= 3)
        return false;
    const Vec3 &a = vertices[edge.a], &b = vertices[edge.b], &pc = vertices[c], &pd = vertices[d];
    const Vec3 before = areaNormal(edge.left) + areaNormal(edge.right);
    const Vec3 first = (pd - a).cross(pc - a), second = (pc - b).cross(pd - b);
    if (first.dot(before) < 0.5 * first.norm() * before.norm()) return false;
    if (second.dot(before) < 0.5 * second.norm() * before.norm()) return false;
    if (std::min(quality(a, pd, pc), quality(b, pc, pd)) < leastQuality) return false;

    triangles[edge.left] = {edge.a, d, c};
    triangles[edge.right] = {edge.b, c, d};
    removeOne(around[edge.b], edge.left);
    removeOne(around[edge.a], edge.right);
    around[d].push_back(edge.left);
    around[c].push_back(edge.right);
    return true;
}

} // namespace doghead
