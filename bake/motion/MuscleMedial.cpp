#include "bake/motion/MuscleMedial.h"

#include <algorithm>

namespace tss {
namespace {

constexpr int smoothingRounds = 8;
constexpr int bisections = 30;

/// Largest r with dist(x - r n, mesh) >= r - slack: monotone in r.
double touchingBall(const Vec3& x, const Vec3& n, double largest, double slack,
                    const ClosestPointQuery& locator) {
    double lower = 0, upper = largest;
    for (int i = 0; i < bisections; ++i) {
        const double r = (lower + upper) / 2;
        const NearestPoint hit = locator.nearest(x - r * n, r);
        (hit.triangle < 0 || hit.distance >= r - slack ? lower : upper) = r;
    }
    return lower;
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
        directions[v] = length > 0 ? Vec3(directions[v] / length) : normals[v];
        if (normals[v].squaredNorm() > 0)
            radii[v] = touchingBall(mesh.vertices[v], normals[v], largest, slack, locator);
    }
    smooth(radii, rings);
    std::vector<Vec3> offsets(radii.size());
    for (std::size_t v = 0; v < radii.size(); ++v) offsets[v] = radii[v] * directions[v];
    return offsets;
}

} // namespace tss
