#include "bake/motion/MuscleMedial.h"

#include "bake/motion/MuscleVolume.h"

#include <algorithm>

namespace tss {
namespace {

constexpr int smoothingRounds = 8;
constexpr int bisections = 30;
constexpr double leastLength = 0.3; // of a mean of unit normals; a shorter one has no sure direction

/// Whether a point is outside of the surface, judged by the triangle of its closest point `hit`: within 60
/// degrees of the triangle's normal, since near an edge the side of one triangle alone says little.
bool isOutside(const TriangleMesh& mesh, const Vec3& point, const NearestPoint& hit) {
    const Vec3 n = mesh.areaNormal(static_cast<std::size_t>(hit.triangle));
    return (point - hit.point).dot(n) > 0.5 * hit.distance * n.norm();
}

/// Largest r with dist(x - r n, mesh) >= r - slack that does not leave the body: monotone in r.
double touchingBall(const TriangleMesh& mesh, const Vec3& x, const Vec3& n, double largest, double slack,
                    const ClosestPointQuery& locator) {
    double lower = 0, upper = largest;
    for (int i = 0; i < bisections; ++i) {
        const double r = (lower + upper) / 2;
        const Vec3 centre = x - r * n;
        const NearestPoint hit = locator.nearest(centre, r);
        const bool inside = hit.triangle < 0 || (hit.distance >= r - slack && !isOutside(mesh, centre, hit));
        (inside ? lower : upper) = r;
    }
    return lower;
}

/// Scales the offsets up where the volume that they sweep, to first order, is less than that of the body:
/// inscribed balls fill a body, but on coarse or rough surfaces those that touch at vertices are too small.
void scaleToVolume(const TriangleMesh& mesh, std::vector<Vec3>& offsets) {
    const Vec3& o = mesh.vertices.front();
    double volume = 0, thickened = 0;
    for (const Tri& t : closed(mesh).triangles) {
        const Vec3 a = mesh.vertices[t[0]] - o, b = mesh.vertices[t[1]] - o, c = mesh.vertices[t[2]] - o;
        const Vec3 n = (b - a).cross(c - a) / 6;
        volume += n.dot(a);
        thickened += n.dot(offsets[t[0]] + offsets[t[1]] + offsets[t[2]]);
    }
    if (!(thickened > 0 && thickened < volume)) return;
    for (Vec3& offset : offsets) offset *= volume / thickened;
}

std::vector<std::vector<int>> neighbours(const TriangleMesh& mesh) {
    std::vector<std::vector<int>> rings(mesh.vertices.size());
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            rings[t[k]].push_back(t[(k + 1) % 3]);
            rings[t[k]].push_back(t[(k + 2) % 3]);
        }
    for (auto& ring : rings) {
        std::sort(ring.begin(), ring.end());
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    }
    return rings;
}

template <class T>
void smooth(std::vector<T>& values, const std::vector<std::vector<int>>& rings) {
    for (int round = 0; round < smoothingRounds; ++round) {
        std::vector<T> next = values;
        for (std::size_t v = 0; v < values.size(); ++v) {
            if (rings[v].empty()) continue;
            T sum = values[v];
            for (int w : rings[v]) sum += values[w];
            next[v] = sum / static_cast<double>(rings[v].size() + 1);
        }
        values = std::move(next);
    }
}

} // namespace

std::vector<Vec3> medialOffsets(const TriangleMesh& mesh, const ClosestPointQuery& locator,
                                const std::vector<Vec3>& normals) {
    double edges = 0;
    for (const Tri& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) edges += (mesh.vertices[t[k]] - mesh.vertices[t[(k + 1) % 3]]).norm();
    const double edge =
        mesh.triangles.empty() ? 0 : edges / (3.0 * static_cast<double>(mesh.triangles.size()));
    const double largest = diagonal(mesh) / 2;
    // A vertex in a slight dent would touch only a tiny ball: it may sink in by a share of the edge.
    const double slack = 0.1 * edge;

    const auto rings = neighbours(mesh);
    std::vector<Vec3> directions = normals;
    smooth(directions, rings);
    std::vector<double> radii(mesh.vertices.size(), 0);
    for (std::size_t v = 0; v < radii.size(); ++v) {
        const double length = directions[v].norm();
        // On so coarse a mesh that the muscle's other side is among the neighbours, normals cancel.
        const bool outward = length > leastLength;
        directions[v] = outward ? Vec3(directions[v] / length) : normals[v];
        if (normals[v].squaredNorm() > 0)
            radii[v] = touchingBall(mesh, mesh.vertices[v], normals[v], largest, slack, locator);
    }
    smooth(radii, rings);
    std::vector<Vec3> offsets(radii.size());
    for (std::size_t v = 0; v < radii.size(); ++v) offsets[v] = radii[v] * directions[v];
    if (!offsets.empty()) scaleToVolume(mesh, offsets);
    return offsets;
}

} // namespace tss
