#include "bake/motion/MuscleVolume.h"

#include "bake/base/Order.h"
#include "bake/geometry/OpenEdges.h"
#include "bake/geometry/PartSet.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace tss {

double enclosedVolume(const std::vector<Vec3>& vertices, const std::vector<Tri>& triangles) {
    if (vertices.empty()) return 0;
    const Vec3& o = vertices.front();
    double sum = 0;
    for (const Tri& t : triangles)
        sum += (vertices[t[0]] - o).dot((vertices[t[1]] - o).cross(vertices[t[2]] - o));
    return sum / 6;
}

TriangleMesh closed(TriangleMesh mesh) {
    const std::vector<Tri> closing = closingTriangles(mesh);
    mesh.triangles.insert(mesh.triangles.end(), closing.begin(), closing.end());
    return mesh;
}

double openShare(const TriangleMesh& mesh) {
    const TriangleMesh whole = closed(mesh);
    std::map<int, Vec3> openings; // by apex; the sum of the normals does not depend on how it is closed
    for (std::size_t t = mesh.triangles.size(); t < whole.triangles.size(); ++t)
        openings.try_emplace(whole.triangles[t][2], Vec3::Zero()).first->second += whole.areaNormal(t);
    double open = 0;
    for (const auto& [apex, normal] : openings) open += normal.norm() / 2;
    const double all = area(mesh);
    return all > 0 ? open / all : 0;
}

bool enclosesVolume(const TriangleMesh& mesh) {
    constexpr double flat = 1e-9; // mean thickness, as a share of the size
    if (mesh.empty()) return false;
    const double volume = enclosedVolume(mesh.vertices, closed(mesh).triangles);
    return volume > flat * area(mesh) * diagonal(mesh);
}

std::array<double, 4> swollenVolume(double wanted, std::span<const Vec3> places,
                                    std::span<const Vec3> swelling, const std::vector<Tri>& triangles) {
    std::array<double, 4> c{-6 * wanted, 0, 0, 0};
    for (const Tri& t : triangles) {
        const Vec3 &p0 = places[t[0]], &p1 = places[t[1]], &p2 = places[t[2]];
        const Vec3 &q0 = swelling[t[0]], &q1 = swelling[t[1]], &q2 = swelling[t[2]];
        const Vec3 p01 = p0.cross(p1), q01 = q0.cross(q1), mixed = p0.cross(q1) + q0.cross(p1);
        c[0] += p01.dot(p2);
        c[1] += p01.dot(q2) + mixed.dot(p2);
        c[2] += mixed.dot(q2) + q01.dot(p2);
        c[3] += q01.dot(q2);
    }
    return c;
}

double swellingFor(double wanted, const std::array<double, 4>& c, double start) {
    double k = start;
    for (int i = 0; i < 30; ++i) {
        const double f = c[0] + k * (c[1] + k * (c[2] + k * c[3]));
        const double slope = c[1] + k * (2 * c[2] + k * 3 * c[3]);
        if (!(std::abs(slope) > 1e-9 * wanted)) return start;
        const double step = std::clamp(f / slope, -0.5, 0.5);
        k -= step;
        if (std::abs(step) <= 1e-15 * std::abs(k)) break;
    }
    return k;
}

double boundedSwelling(const std::array<double, 4>& c, double leastSlope, double least, double most) {
    // The values of k at which the slope c1 + 2 c2 k + 3 c3 k^2 equals leastSlope.
    std::array<double, 2> crossings{0, 0};
    const double a = 3 * c[3], b = 2 * c[2], rest = c[1] - leastSlope, inside = b * b - 4 * a * rest;
    if (inside > 0) {
        const double q = -(b + std::copysign(std::sqrt(inside), b)) / 2;
        crossings = {a != 0 ? q / a : 0, q != 0 ? rest / q : 0};
        if (crossings[0] > crossings[1]) std::swap(crossings[0], crossings[1]);
    }
    // The modified cubic at k: the integral from 0 to k of max(slope, leastSlope).
    const auto value = [&](double k) {
        double sum = c[0] + k * leastSlope, from = 0;
        for (const double crossing : {crossings[k < 0], crossings[k >= 0], k}) {
            const double to = k < 0 ? std::clamp(crossing, k, from) : std::clamp(crossing, from, k);
            const double middle = (from + to) / 2;
            if (rest + middle * (b + middle * a) > 0)
                sum += rest * (to - from) + c[2] * (to * to - from * from) +
                       c[3] * (to * to * to - from * from * from);
            from = to;
        }
        return sum;
    };
    if (c[0] == 0) return 0;
    double low = c[0] > 0 ? least : 0, high = c[0] > 0 ? 0 : most;
    if (value(low) >= 0) return low;
    if (value(high) <= 0) return high;
    for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2)
        (value(middle) < 0 ? low : high) = middle;
    return high;
}

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
        sortOnce(ring);
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
