#include "bake/spheres/RestNeighbour.h"

#include <algorithm>

namespace tss {

namespace {

/// Of what the surface has to the other body, so much is kept by the balls inside; the rest is left to them.
constexpr double share = 0.75;

/// Shrinks r until the ball about p - r n, its radius grown by `apart`, has no point of what `nearest` tells
/// of: the vector from the nearest centre to p and how much closer than `apart` that centre may not be.
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

double RestNeighbour::largest(const Vec3& centre, double inner) const {
    const Vec3 x = toOther * centre;
    double radius = std::numeric_limits<double>::infinity();
    if (body) radius = std::min(radius, (body->distance(x) + inner) / 2 - spare);
    if (parts) radius = std::min(radius, parts->distance(x) - beside);
    if (spheres) radius = std::min(radius, spheres->nearest(x).gap - spare);
    return radius;
}

double RestNeighbour::shrunk(const Vec3& p, const Vec3& n, double longest, double protrusion) const {
    const Vec3 at = toOther * p, along = toOther.linear() * n;
    double r = longest;
    if (body) {
        const double apart = std::min(share * body->distance(at), 2 * (protrusion + spare));
        r = shrink(at, along, r, apart, nearestOf(*body));
    }
    if (parts) {
        const double apart = std::min(share * parts->distance(at), protrusion + beside);
        r = shrink(at, along, r, apart, nearestOf(*parts));
    }
    if (spheres) {
        const double gap = spheres->nearest(at).gap - spare;
        r = shrink(at, along, r, spare + std::min(share * gap, protrusion),
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
