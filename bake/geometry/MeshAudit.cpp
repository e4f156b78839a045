#include "bake/geometry/MeshAudit.h"

#include "bake/base/Error.h"
#include "bake/base/Order.h"
#include "bake/base/UnionFind.h"
#include "bake/base/Words.h"
#include "bake/geometry/Bvh.h"
#include "bake/geometry/Import.h"
#include "bake/geometry/TriangleDistance.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace tss {

namespace {

bool inRange(const TriangleMesh& mesh, const Tri& t) {
    return t.minCoeff() >= 0 && t.maxCoeff() < static_cast<int>(mesh.vertices.size());
}

/// The corners rotated so that the least index comes first: a key of the triangle and its orientation.
std::array<int, 3> orientedKey(const Tri& t) {
    int k = 0;
    t.minCoeff(&k);
    return {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
}

/// For every triangle, whether an earlier one is the same.
std::vector<char> duplicates(const TriangleMesh& mesh) {
    std::vector<std::pair<std::array<int, 3>, std::size_t>> keys;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        keys.push_back({orientedKey(mesh.triangles[t]), t});
    std::sort(keys.begin(), keys.end());
    std::vector<char> repeated(keys.size(), 0);
    for (std::size_t i = 1; i < keys.size(); ++i)
        if (keys[i].first == keys[i - 1].first) repeated[keys[i].second] = 1;
    return repeated;
}

/// Pairs of triangles that have the same corners in opposite senses, each counted once however
/// often it is given.
int countTurnedOver(const TriangleMesh& mesh) {
    std::vector<std::array<int, 3>> keys;
    for (const Tri& t : mesh.triangles)
        if (inRange(mesh, t) && t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) keys.push_back(orientedKey(t));
    sortOnce(keys);
    const auto isThere = [&](const std::array<int, 3>& key) {
        return key[1] < key[2] &&
               std::binary_search(keys.begin(), keys.end(), std::array{key[0], key[2], key[1]});
    };
    return static_cast<int>(std::count_if(keys.begin(), keys.end(), isThere));
}

struct HalfEdge {
    int from, to; // from < to
    bool forward; // the triangle runs from `from` to `to`
    bool operator<(const HalfEdge& o) const {
        return std::tie(from, to, forward) < std::tie(o.from, o.to, o.forward);
    }
};

void countEdges(const TriangleMesh& mesh, MeshAudit& audit) {
    std::vector<HalfEdge> edges;
    for (const Tri& t : mesh.triangles) {
        if (!inRange(mesh, t)) continue;
        for (int k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (a != b) edges.push_back({std::min(a, b), std::max(a, b), a < b});
        }
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end].from == edges[i].from && edges[end].to == edges[i].to) ++end;
        if (end - i == 1) ++audit.openEdges;
        if (end - i > 2) ++audit.nonManifoldEdges;
        if (end - i == 2 && edges[i].forward == edges[i + 1].forward) ++audit.misorientedEdges;
    }
}

int countComponents(const TriangleMesh& mesh) {
    UnionFind together(mesh.vertices.size());
    for (const Tri& t : mesh.triangles)
        if (inRange(mesh, t)) {
            together.join(t[0], t[1]);
            together.join(t[0], t[2]);
        }
    std::vector<char> seen(mesh.vertices.size(), 0);
    int count = 0;
    for (const Tri& t : mesh.triangles)
        if (inRange(mesh, t) && !std::exchange(seen[together.root(t[0])], 1)) ++count;
    return count;
}

void countVertices(const TriangleMesh& mesh, MeshAudit& audit) {
    std::vector<char> used(mesh.vertices.size(), 0);
    for (const Tri& t : mesh.triangles)
        if (inRange(mesh, t))
            for (int k = 0; k < 3; ++k) used[t[k]] = 1;
    audit.unusedVertices = static_cast<int>(std::count(used.begin(), used.end(), 0));
    audit.notFinite =
        static_cast<int>(std::ranges::count_if(mesh.vertices, [](const Vec3& v) { return !v.allFinite(); }));
    audit.duplicateVertices = static_cast<int>(mesh.vertices.size() - welded(mesh).vertices.size());
}

} // namespace

bool hasZeroArea(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, bc = c - b, ca = a - c;
    const double longest2 = std::max({ab.squaredNorm(), bc.squaredNorm(), ca.squaredNorm()});
    // Scaled first, so that triangles of 1e-100 units have the area they have.
    const double scale = std::sqrt(longest2);
    return !(scale > 0) || (ab / scale).cross(ca / scale).norm() < 1e-14;
}

bool hasZeroArea(const TriangleMesh& mesh, std::size_t triangle) {
    return hasZeroArea(mesh.corner(triangle, 0), mesh.corner(triangle, 1), mesh.corner(triangle, 2));
}

MeshAudit auditMesh(const TriangleMesh& mesh) {
    MeshAudit audit;
    audit.vertices = static_cast<int>(mesh.vertices.size());
    audit.triangles = static_cast<int>(mesh.triangles.size());
    countEdges(mesh, audit);
    countVertices(mesh, audit);
    audit.components = countComponents(mesh);
    audit.turnedOverTriangles = countTurnedOver(mesh);
    const std::vector<char> repeated = duplicates(mesh);
    const Vec3 origin = mesh.vertices.empty() ? Vec3(Vec3::Zero()) : mesh.vertices[0];
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        audit.duplicateTriangles += repeated[t];
        if (!inRange(mesh, mesh.triangles[t])) {
            ++audit.badIndices;
            continue;
        }
        const Vec3 a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
        audit.zeroAreaTriangles += hasZeroArea(a, b, c);
        audit.signedVolume += (a - origin).dot((b - origin).cross(c - origin)) / 6;
    }
    audit.watertight = audit.triangles > 0 && audit.badIndices == 0 && audit.openEdges == 0 &&
                       audit.nonManifoldEdges == 0 && audit.misorientedEdges == 0;
    return audit;
}

std::string text(const MeshAudit& audit) {
    std::string s = fmt::format("{} vertices, {} triangles, {}{}", audit.vertices, audit.triangles,
                                counted(static_cast<std::size_t>(audit.components), "component"),
                                audit.watertight ? ", watertight" : "");
    const auto say = [&s](int count, const char* what) {
        if (count > 0) s += fmt::format("\n{} {}", count, what);
    };
    say(audit.notFinite, "vertices with a NaN or infinite coordinate");
    say(audit.badIndices, "triangles with an index out of range");
    say(audit.openEdges, "open edges");
    say(audit.nonManifoldEdges, "edges of more than two triangles");
    say(audit.misorientedEdges, "edges whose two triangles turn against each other");
    say(audit.zeroAreaTriangles, "triangles of no area");
    say(audit.duplicateTriangles, "triangles given more than once");
    say(audit.turnedOverTriangles, "triangles given a second time turned over: such a pair bounds no inside");
    say(audit.unusedVertices, "vertices in no triangle");
    say(audit.duplicateVertices, "vertices at the place of another");
    if (audit.insideOut()) s += "\ninside out: its volume is negative";
    return s;
}

void checkIndices(const TriangleMesh& mesh) {
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        if (!mesh.vertices[v].allFinite())
            throw InputError("vertex " + std::to_string(v) +
                             " is not finite; every coordinate must be a number");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        if (!inRange(mesh, mesh.triangles[t]))
            throw InputError("triangle " + std::to_string(t) + " names a vertex outside 0.." +
                             std::to_string(static_cast<long>(mesh.vertices.size()) - 1));
}

namespace {

/// The triangles of a mesh that have an area, in a tree: tells which zero-area triangles lie on them.
class SolidTriangles {
public:
    SolidTriangles(const TriangleMesh& mesh, const std::vector<char>& flat) : mesh_(mesh) {
        std::vector<Eigen::AlignedBox3d> boxes;
        double size = 0;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            if (flat[t]) continue;
            triangles_.push_back(t);
            const Eigen::AlignedBox3d& box = boxes.emplace_back(bounds(mesh, t));
            size = std::max({size, box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff()});
        }
        rounding_ = 4 * std::numeric_limits<double>::epsilon() * size;
        tree_ = buildBvh(boxes);
    }

    /// Whether a zero-area triangle adds nothing to the surface: its longest edge lies on a triangle with an
    /// area, or both parts that the third corner divides that edge into do.
    bool cover(std::size_t t) const {
        int k = 0;
        double longest = -1;
        for (int i = 0; i < 3; ++i)
            if (const double length = (mesh_.corner(t, (i + 1) % 3) - mesh_.corner(t, i)).norm();
                length > longest) {
                longest = length;
                k = i;
            }
        const Vec3 &a = mesh_.corner(t, k), &b = mesh_.corner(t, (k + 1) % 3),
                   &c = mesh_.corner(t, (k + 2) % 3);
        const double near = rounding_ + 2e-14 * longest;
        return coverSegment(a, b, near) || (coverSegment(a, c, near) && coverSegment(c, b, near));
    }

private:
    /// Whether both ends of a segment, and so all of it, lie on one triangle.
    bool coverSegment(const Vec3& a, const Vec3& b, double near) const {
        bool held = false;
        visitBall(tree_, a, near, [&](std::uint32_t i) {
            const auto on = [&](const Vec3& p) {
                const std::size_t t = triangles_[i];
                const Vec3 q =
                    closestOnTriangle(p, mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2));
                return (q - p).norm() <= near;
            };
            held = held || (on(a) && on(b));
        });
        return held;
    }

    const TriangleMesh& mesh_;
    std::vector<std::size_t> triangles_;
    Bvh tree_;
    double rounding_ = 0;
};

/// For every triangle, whether cleaned() leaves it out.
std::vector<char> redundantTriangles(const TriangleMesh& mesh) {
    std::vector<char> without = duplicates(mesh), flat(mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < flat.size(); ++t) flat[t] = hasZeroArea(mesh, t);
    const auto count = std::count(flat.begin(), flat.end(), 1);
    if (count == static_cast<std::ptrdiff_t>(flat.size()))
        throw InputError("the mesh has no triangle with an area (" + std::to_string(mesh.vertices.size()) +
                         " vertices, " + std::to_string(mesh.triangles.size()) + " triangles)");
    if (count == 0) return without;
    const SolidTriangles solid(mesh, flat);
    for (std::size_t t = 0; t < flat.size(); ++t)
        if (flat[t] && !without[t]) without[t] = solid.cover(t);
    return without;
}

} // namespace

TriangleMesh cleaned(const TriangleMesh& mesh, std::vector<std::uint32_t>* loaded) {
    checkIndices(mesh);
    if (loaded) loaded->clear();
    const std::vector<char> without = redundantTriangles(mesh);
    TriangleMesh result;
    std::vector<int> place(mesh.vertices.size(), -1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (without[t]) continue;
        result.triangles.push_back(mesh.triangles[t]);
        if (loaded) loaded->push_back(static_cast<std::uint32_t>(t));
        for (int k = 0; k < 3; ++k) place[mesh.triangles[t][k]] = 0;
    }
    for (std::size_t v = 0; v < place.size(); ++v)
        if (place[v] == 0) {
            place[v] = static_cast<int>(result.vertices.size());
            result.vertices.push_back(mesh.vertices[v]);
        }
    for (Tri& t : result.triangles) t = Tri(place[t[0]], place[t[1]], place[t[2]]);
    return result;
}

} // namespace tss
