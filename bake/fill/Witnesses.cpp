#include "bake/fill/Witnesses.h"

#include "bake/base/Order.h"
#include "bake/geometry/ConnectedParts.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace tss {

namespace {

constexpr int ballsPerPart = 6;
constexpr std::size_t verticesPerPart = 64;
constexpr int pointsPerAxis = 7; // of the grid that balls start from

/// The radius of the ball about a point that the solid has around it, < 0 outside.
double depthOf(const Solid& solid, const Vec3& p) {
    return solid.inside(p) ? solid.boundary().distance(p) : -1;
}

/// The ball nearby that is as large as steps along the axes find it.
Witness grown(const Solid& solid, Witness ball, double step) {
    for (int halving = 0; halving < 6; ++halving, step *= 0.5)
        for (bool better = true; better;) {
            better = false;
            for (int way = 0; way < 6; ++way) {
                const Vec3 p = ball.centre + (way % 2 ? step : -step) * Vec3::Unit(way / 2);
                const double depth = depthOf(solid, p);
                if (!(depth > ball.radius * (1 + 1e-3))) continue;
                ball = {p, depth};
                better = true;
            }
        }
    return ball;
}

/// Balls inside a closed part, none with its centre in another, the largest first.
void addBalls(const Solid& solid, PartWitnesses& part) {
    const Eigen::AlignedBox3d box = bounds(solid.mesh());
    const Vec3 spacing = box.sizes() / pointsPerAxis;
    std::vector<Witness> starts;
    for (int i = 0; i < pointsPerAxis * pointsPerAxis * pointsPerAxis; ++i) {
        const Vec3 place(i % pointsPerAxis, i / pointsPerAxis % pointsPerAxis,
                         i / (pointsPerAxis * pointsPerAxis));
        const Vec3 p = box.min() + (place.array() + 0.5).matrix().cwiseProduct(spacing);
        if (const double depth = depthOf(solid, p); depth > 0) starts.push_back({p, depth});
    }
    std::stable_sort(starts.begin(), starts.end(),
                     [](const Witness& x, const Witness& y) { return x.radius > y.radius; });
    const auto taken = [&](const Vec3& p) {
        return std::any_of(part.begin(), part.end(),
                           [&](const Witness& w) { return (w.centre - p).norm() < w.radius; });
    };
    for (const Witness& start : starts) {
        if (part.size() == ballsPerPart) break;
        if (taken(start.centre)) continue;
        Witness ball = grown(solid, start, spacing.maxCoeff() / 2);
        if (taken(ball.centre)) ball = start;
        part.push_back(ball);
    }
    for (Witness& ball : part) ball.radius *= 1 - 1e-9; // distances are rounded
    std::stable_sort(part.begin(), part.end(),
                     [](const Witness& x, const Witness& y) { return x.radius > y.radius; });
}

void addVertices(const TriangleMesh& mesh, PartWitnesses& part) {
    std::vector<std::size_t> found = farthestOut(mesh);
    sortOnce(found);
    for (const std::size_t v : found) part.push_back({mesh.vertices[v]});
    // All over the part: the next is farthest from those before it.
    std::vector<double> apart(mesh.vertices.size(), std::numeric_limits<double>::infinity());
    const auto near = [&](std::size_t taken) {
        for (std::size_t v = 0; v < apart.size(); ++v)
            apart[v] = std::min(apart[v], (mesh.vertices[v] - mesh.vertices[taken]).squaredNorm());
    };
    for (const std::size_t v : found) near(v);
    while (found.size() < verticesPerPart) {
        const auto farthest = std::max_element(apart.begin(), apart.end());
        if (!(*farthest > 0)) break;
        found.push_back(farthest - apart.begin());
        part.push_back({mesh.vertices[found.back()]});
        near(found.back());
    }
}

} // namespace

std::vector<PartWitnesses> witnessesOf(const TriangleMesh& mesh) {
    std::vector<PartWitnesses> parts;
    for (const TriangleMesh& one : connectedParts(mesh)) {
        PartWitnesses part;
        if (const Solid solid(one); !solid.open()) addBalls(solid, part);
        addVertices(one, part);
        parts.push_back(std::move(part));
    }
    return parts;
}

} // namespace tss
