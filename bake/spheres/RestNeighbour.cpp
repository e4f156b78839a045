#include "bake/spheres/RestNeighbour.h"

#include <algorithm>

namespace tss {

namespace {

/// Balls inside keep at least this share of the distance that p itself has to the other body.
constexpr double share = 0.75;

/// Shrinks r until the ball about p - r n through p is at least `apart` away from an obstacle. nearest(x,
/// within): the part of the obstacle nearest to x, a point or a sphere, if any is nearer than `within`.
template <class Nearest>
double shrink(const Vec3& p, const Vec3& n, double r, double apart, const Nearest& nearest) {
    if (!(apart > 0)) return r;
    for (int round = 0; round < 200 && r > 0; ++round) {
        const auto [found, point, radius] = nearest(Vec3(p - r * n), r + apart);
        if (!found) return r;
        const Vec3 v = p - point;
        const double least = radius + apart, facing = v.dot(n) + least;
        const double next = facing > 0 ? (v.squaredNorm() - least * least) / (2 * facing) : r;
        r = std::max(0.0, std::min(next, r * (1 - 1e-9)));
    }
    return r;
}

/// A point of an obstacle, or a sphere of it.
struct Found {
    bool any;
    Vec3 centre;
    double radius;
};

auto nearestOf(const MeshQuery& mesh) {
    return [&mesh](const Vec3& x, double within) {
        const ClosestPoint near = mesh.closest(x, within);
        return Found{near.triangle >= 0, near.point, 0};
    };
}

} // namespace

double RestNeighbour::largestRadius(const Vec3& centre, double inner) const {
    const Vec3 x = toOther * centre;
    double radius = std::numeric_limits<double>::infinity();
    if (body) radius = std::min(radius, (body->distance(x) + inner) / 2 - halfGap);
    if (parts) radius = std::min(radius, parts->distance(x) - partGap);
    if (spheres) radius = std::min(radius, spheres->nearest(x).gap - halfGap);
    return radius;
}

double RestNeighbour::shrunkBall(const Vec3& p, const Vec3& n, double longest, double protrusion) const {
    const Vec3 at = toOther * p, along = toOther.linear() * n;
    double r = longest;
    if (body) {
        const double apart = std::min(share * body->distance(at), 2 * (protrusion + halfGap));
        r = shrink(at, along, r, apart, nearestOf(*body));
    }
    if (parts) {
        const double apart = std::min(share * parts->distance(at), protrusion + partGap);
        r = shrink(at, along, r, apart, nearestOf(*parts));
    }
    if (spheres) {
        const double gap = spheres->nearest(at).gap - halfGap;
        r = shrink(at, along, r, halfGap + std::min(share * gap, protrusion),
                   [&](const Vec3& x, double within) {
                       const SphereQuery::Nearest near = spheres->nearest(x);
                       if (near.sphere < 0 || near.gap >= within) return Found{false, x, 0};
                       const Sphere& sphere = (*spheres)[near.sphere];
                       return Found{true, sphere.centre, sphere.radius};
                   });
    }
    return r;
}

} // namespace tss
