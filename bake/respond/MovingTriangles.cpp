#include "bake/respond/MovingTriangles.h"

#include <algorithm>
#include <cmath>

namespace tss {
namespace {

using Box = Eigen::AlignedBox3d;

/// The most that vectors of two boxes differ, and the most of their products.
double mostApart(const Box& a, const Box& b) {
    return (a.max() - b.min()).cwiseMax(b.max() - a.min()).norm();
}
double mostAlong(const Box& a, const Box& b) {
    const Vec3 low = (a.min().cwiseProduct(b.min())).cwiseMax(a.min().cwiseProduct(b.max())),
               high = (a.max().cwiseProduct(b.min())).cwiseMax(a.max().cwiseProduct(b.max()));
    return low.cwiseMax(high).sum();
}
double squaredDistance(const Box& a, const Box& b) {
    return (a.min() - b.max()).cwiseMax(b.min() - a.max()).cwiseMax(0.0).squaredNorm();
}

constexpr double rounding = 1e-9; ///< relative, of the bounds of a node

} // namespace

MovingTriangles::MovingTriangles(TriangleMesh rest)
    : now_(std::move(rest)), rest_(now_.vertices), moves_(rest_.size(), Vec3::Zero()), tree_(buildBvh(now_)),
      bounds_(tree_.nodes.size()) {
    moveTo(rest_, rest_);
}

void MovingTriangles::Bounds::extend(const Bounds& other) {
    places.extend(other.places);
    moves.extend(other.moves);
    normals.extend(other.normals);
    changed = changed || other.changed;
}

bool MovingTriangles::hasChanged(std::uint32_t triangle) const {
    const Tri& t = now_.triangles[triangle];
    return std::ranges::any_of(t, [&](int v) { return changed(static_cast<std::size_t>(v)); });
}

MovingTriangles::Bounds MovingTriangles::boundsOf(std::uint32_t triangle) const {
    Bounds result{tss::bounds(now_, triangle), {}, {}, hasChanged(triangle)};
    for (int k = 0; k < 3; ++k) result.moves.extend(moves_[now_.triangles[triangle][k]]);
    result.normals.extend(now_.areaNormal(triangle).normalized());
    return result;
}

void MovingTriangles::moveTo(const std::vector<Vec3>& places, const std::vector<Vec3>& before) {
    for (std::size_t v = 0; v < places.size(); ++v) moves_[v] = places[v] - before[v];
    now_.vertices = places;
    for (std::size_t i = bounds_.size(); i-- > 0;) {
        const Bvh::Node& node = tree_.nodes[i];
        Bounds all;
        for (std::uint32_t k = 0; k < node.count; ++k) all.extend(boundsOf(tree_.items[node.first + k]));
        if (node.count == 0)
            for (const std::uint32_t child : {node.first, node.first + 1}) all.extend(bounds_[child]);
        bounds_[i] = all;
    }
}

double MovingTriangles::halfOf(std::uint32_t triangle, const Vec3& weights, const Vec3& move) const {
    Vec3 against = move;
    for (int k = 0; k < 3; ++k) against -= weights[k] * moves_[now_.triangles[triangle][k]];
    return against.norm() / 2;
}

double MovingTriangles::squaredDistanceOf(std::uint32_t node, const Group& group, double reach,
                                          bool onlyChanged) const {
    const Bounds& bounds = bounds_[node];
    if (onlyChanged && !bounds.changed) return infinity;
    const double distance2 = squaredDistance(bounds.places, group.places) * (1 - rounding);
    if (distance2 >= reach * reach) {
        if (group.moves.isEmpty()) return infinity;
        const double most = reach + mostApart(bounds.moves, group.moves) / 2 * (1 + rounding);
        if (!(distance2 < most * most)) return infinity;
    }
    return mostAlong(bounds.normals, group.facings) >= -rounding ? distance2 : infinity;
}

bool MovingTriangles::mayMeet(const Group& group, double reach, bool onlyChanged) const {
    double best2 = infinity;
    const auto least2 = [&](std::uint32_t node) {
        return squaredDistanceOf(node, group, reach, onlyChanged);
    };
    visitNearest(tree_, least2, best2, [&](std::uint32_t) { best2 = -1; });
    return best2 < 0;
}

MovingTriangles::Met MovingTriangles::nearest(const Vec3& x, const Vec3& facing, double reach,
                                              bool onlyChanged, const Vec3* move) const {
    Met best;
    const bool any = facing.isZero(0);
    double best2 = infinity;
    const auto look = [&](std::uint32_t triangle) {
        if (onlyChanged && !hasChanged(triangle)) return;
        if (!any && !(now_.areaNormal(triangle).dot(facing) > 0)) return;
        const auto [a, b, c] = now_.corners(triangle);
        const Vec3 w = nearestOnTriangle(x, a, b, c), p = w[0] * a + w[1] * b + w[2] * c;
        const double distance2 = (p - x).squaredNorm();
        if (!(distance2 < best2)) return;
        const double half = move ? halfOf(triangle, w, *move) : 0, distance = std::sqrt(distance2);
        if (!(distance < reach + half)) return;
        best2 = distance2;
        best = {NearestPoint{static_cast<int>(triangle), w, p, distance}, half};
    };
    const Group point{Box(x), Box(facing), move ? Box(*move) : Box()};
    const auto least2 = [&](std::uint32_t node) {
        return squaredDistanceOf(node, point, reach, onlyChanged);
    };
    visitNearest(tree_, least2, best2, look);
    return best;
}

} // namespace tss
