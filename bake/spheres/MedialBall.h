#pragma once
#include "bake/geometry/Solid.h"
#include "bake/spheres/RestNeighbour.h"
#include "bake/spheres/SphereSet.h"

namespace tss {

/// The largest r <= longest for which the ball about p - r n with radius r reaches at most `slack` through
/// the boundary: r - dist(p - r n) <= slack (METHOD 1.3). That is monotone in r; a ball that reaches too far
/// is shrunk to pass through the boundary point nearest to its centre, again and again. Distances are exact.
/// n of unit length. hint > 0: the radius to start with. Returns r, or 0 where none was found.
double largestBall(const MeshQuery& boundary, const Vec3& p, const Vec3& n, double slack, double longest,
                   double hint);

/// A ball known to lie inside the solid, empty at first. Points in it need no winding number.
struct KnownInside {
    Vec3 centre = Vec3::Zero();
    double radius = 0;
};

/// A sphere and the ball about its centre that is inside the solid.
struct MedialBall {
    Sphere sphere;
    double inner = 0;         ///< radius of that ball, scene units
    double unconstrained = 0; ///< the radius that it would have without a neighbour, scene units
    double protrusion() const { return sphere.radius - inner; }
};

/// The sphere that stands for the surface about p, which lies on the boundary, seen along -n (METHOD 1.3): a
/// ball inside the solid grown by `protrusion`. It contains every point within protrusion - slack of p and
/// its proven protrusion is `protrusion`. Where no centre inside is found (a feature thinner than the slack,
/// an open sheet) it is the ball about p itself. slackFactor: the slack over the protrusion, > 0, much
/// less than 1. hint: a radius expected, or 0. known: read, and replaced by the ball found. neighbour: null,
/// or what the sphere must stay clear of; it then sticks out by as much less as that takes.
MedialBall medialBall(const Solid& solid, const Vec3& p, const Vec3& n, double protrusion, double slackFactor,
                      double hint, KnownInside& known, const RestNeighbour* neighbour = nullptr);

} // namespace tss
