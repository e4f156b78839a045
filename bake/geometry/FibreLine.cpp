#include "bake/geometry/FibreLine.h"

#include "bake/base/Error.h"
#include "bake/base/Infinity.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>

namespace tss {

namespace {

/// Shortest distances along the edges of a surface (Dijkstra).
class EdgeDistances {
public:
    explicit EdgeDistances(const TriangleMesh& mesh) : mesh_(mesh), next_(mesh.vertices.size()) {
        for (const Tri& t : mesh.triangles)
            for (int k = 0; k < 3; ++k) {
                next_[t[k]].push_back(t[(k + 1) % 3]);
                next_[t[(k + 1) % 3]].push_back(t[k]);
            }
    }

    std::vector<double> from(int vertex) const {
        std::vector<double> lengths(next_.size(), infinity);
        using Entry = std::pair<double, int>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
        lengths[vertex] = 0;
        front.emplace(0, vertex);
        while (!front.empty()) {
            const auto [length, at] = front.top();
            front.pop();
            if (length > lengths[at]) continue;
            for (int to : next_[at]) {
                const double there = length + (mesh_.vertices[to] - mesh_.vertices[at]).norm();
                if (there >= lengths[to]) continue;
                lengths[to] = there;
                front.emplace(there, to);
            }
        }
        return lengths;
    }

private:
    const TriangleMesh& mesh_;
    std::vector<std::vector<int>> next_;
};

int farthest(const std::vector<double>& lengths) {
    int best = -1;
    for (std::size_t v = 0; v < lengths.size(); ++v)
        if (lengths[v] != infinity && (best < 0 || lengths[v] > lengths[best])) best = static_cast<int>(v);
    return best;
}

/// The two ends of a connected component, vertices that are farthest from each other along the surface, and
/// the distance of every vertex from either; infinite in other components.
struct Ends {
    int first = -1, second = -1;
    std::vector<double> fromFirst, fromSecond;
};

Ends endsFrom(const EdgeDistances& distances, int vertex) {
    Ends ends;
    ends.first = farthest(distances.from(vertex));
    ends.fromFirst = distances.from(ends.first);
    ends.second = farthest(ends.fromFirst);
    ends.fromSecond = distances.from(ends.second);
    return ends;
}

Ends longestEnds(const TriangleMesh& mesh) {
    const EdgeDistances distances(mesh);
    std::vector<bool> seen(mesh.vertices.size());
    Ends best;
    double length = -1;
    for (const Tri& t : mesh.triangles) {
        if (seen[t[0]]) continue;
        Ends ends = endsFrom(distances, t[0]);
        for (std::size_t v = 0; v < seen.size(); ++v)
            if (ends.fromFirst[v] != infinity) seen[v] = true;
        const double its = ends.fromFirst[ends.second];
        if (its > length) length = its, best = std::move(ends);
    }
    if (!(length > 0)) throw InputError("a muscle's mesh has no length; expected a closed surface");
    return best;
}

/// The end of the line: straight on from its last point as far as the end slice reaches. The vertex farthest
/// along the surface would not do, as it may lie beside the line.
Vec3 extrapolatedEnd(const TriangleMesh& mesh, const std::vector<double>& here,
                     const std::vector<double>& there, int slices, const Vec3& last, const Vec3& before) {
    const Vec3 direction = (last - before).normalized();
    double farthest = 0;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        if (here[v] < infinity && here[v] * slices < here[v] + there[v])
            farthest = std::max(farthest, direction.dot(mesh.vertices[v] - last));
    return last + farthest * direction;
}

} // namespace

std::vector<Vec3> fibreLine(const TriangleMesh& mesh, int inner) {
    const Ends ends = longestEnds(mesh);
    const int slices = inner + 2; // those at the ends are the ends' own
    std::vector<Vec3> middles(slices, Vec3::Zero());
    std::vector<double> areas(slices, 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
        double first = 0, both = 0;
        for (int k = 0; k < 3; ++k) {
            const int v = mesh.triangles[t][k];
            first += ends.fromFirst[v];
            both += ends.fromFirst[v] + ends.fromSecond[v];
        }
        if (!(both < infinity) || !(both > 0)) continue; // another component
        const int slice = std::min(slices - 1, static_cast<int>(slices * first / both));
        const double area = mesh.areaNormal(t).norm() / 2;
        middles[slice] += area * (a + b + c) / 3;
        areas[slice] += area;
    }
    std::vector<Vec3> line;
    for (int k = 1; k + 1 < slices; ++k)
        if (areas[k] > 0) line.push_back(middles[k] / areas[k]);
    if (line.size() < 2) return {mesh.vertices[ends.first], mesh.vertices[ends.second]};
    const Vec3 first = extrapolatedEnd(mesh, ends.fromFirst, ends.fromSecond, slices, line[0], line[1]);
    const Vec3 last =
        extrapolatedEnd(mesh, ends.fromSecond, ends.fromFirst, slices, line.back(), line[line.size() - 2]);
    line.insert(line.begin(), first);
    line.push_back(last);
    return line;
}

namespace {

/// A surface as point masses, one at the centroid of each triangle.
struct Centroids {
    std::vector<Vec3> centres;
    std::vector<double> areas;
    Vec3 middle = Vec3::Zero(); ///< their centre of mass
    double whole = 0;           ///< sum of the areas
};

Centroids centroidsOf(const TriangleMesh& mesh) {
    Centroids surface;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
        surface.centres.push_back((a + b + c) / 3);
        surface.areas.push_back(mesh.areaNormal(t).norm() / 2);
        surface.middle += surface.areas.back() * surface.centres.back();
        surface.whole += surface.areas.back();
    }
    if (!(surface.whole > 0)) throw InputError("a muscle's mesh has no area; expected a closed surface");
    surface.middle /= surface.whole;
    return surface;
}

/// The middles of slices about an axis; fewer than `points` where some are empty.
std::vector<Vec3> lineAbout(const Centroids& surface, const Vec3& x, const Vec3& y, int points) {
    const auto& [centres, areas, middle, whole] = surface;
    std::vector<Vec3> sums(points, Vec3::Zero());
    std::vector<double> weights(points, 0);
    for (std::size_t t = 0; t < centres.size(); ++t) {
        const Vec3 from = centres[t] - middle;
        const double turn = std::atan2(y.dot(from), x.dot(from)) / (2 * std::numbers::pi) + 0.5;
        const int slice = std::clamp(static_cast<int>(turn * points), 0, points - 1);
        sums[slice] += areas[t] * centres[t];
        weights[slice] += areas[t];
    }
    std::vector<Vec3> line;
    for (int k = 0; k < points; ++k)
        if (weights[k] > 0) line.push_back(sums[k] / weights[k]);
    return line;
}

/// Whether the axis upright on x and y through the middle meets no triangle.
bool isOpen(const TriangleMesh& mesh, const Vec3& middle, const Vec3& x, const Vec3& y) {
    const auto side = [&](const Vec3& a, const Vec3& b) { // of the axis, seen along it
        return x.dot(a - middle) * y.dot(b - middle) - y.dot(a - middle) * x.dot(b - middle);
    };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3 &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
        const double ab = side(a, b), bc = side(b, c), ca = side(c, a);
        if ((ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0)) return false;
    }
    return true;
}

} // namespace

std::vector<Vec3> ringLine(const TriangleMesh& mesh, int points) {
    const Centroids surface = centroidsOf(mesh);
    Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
    for (std::size_t t = 0; t < surface.centres.size(); ++t) {
        const Vec3 from = surface.centres[t] - surface.middle;
        spread += surface.areas[t] / surface.whole * from * from.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread); // the least extent first
    const auto about = [&](int axis) {
        return std::pair<Vec3, Vec3>(axes.eigenvectors().col(axis == 2 ? 1 : 2),
                                     axes.eigenvectors().col(axis == 0 ? 1 : 0));
    };
    // A ring that is higher than wide has its least extent across: it goes round where it is open.
    for (int axis = 0; axis < 3; ++axis) {
        const auto [x, y] = about(axis);
        std::vector<Vec3> line = lineAbout(surface, x, y, points);
        if (static_cast<int>(line.size()) == points && isOpen(mesh, surface.middle, x, y)) return line;
    }
    const auto [x, y] = about(0);
    return lineAbout(surface, x, y, points);
}

} // namespace tss
