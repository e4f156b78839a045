#pragma once
#include "bake/geometry/MeshQuery.h"
#include "bake/spheres/SphereQuery.h"

#include <memory>

namespace tss {

/// What the spheres of a body must stay clear of where the joint rests (METHOD 2.4). A sphere (c, R) about a
/// ball (c, d) inside the body obeys, each where it is given:
///   R <= (D + d) / 2 - halfGap   D the distance of c from the other body. Spheres of both bodies that obey
///   it
///                                have gaps of at least 2 halfGap at rest: a ball (c', d') inside the other
///                                body has D <= |c - c'| - d', and so with the two exchanged; add them up.
///   R <= N - partGap             N the distance of c from parts of the other's surface
///   R <= G - halfGap             G the distance of c from given spheres of the other
/// Immutable; points are in the body's own frame.
struct RestNeighbour {
    Eigen::Isometry3d toOther = Eigen::Isometry3d::Identity(); ///< from this body's frame to the other's
    std::shared_ptr<const MeshQuery> body;  ///< the other's boundary, its openings closed; outside of it
    std::shared_ptr<const MeshQuery> parts; ///< parts of its surface
    std::shared_ptr<const SphereQuery> spheres;
    double halfGap = 0, partGap = 0; ///< scene units, >= 0
    double clearance = 0;            ///< of what must stay apart at rest, scene units, for messages

    /// Whether it may keep any sphere from sticking out by `protrusion`. Where nothing else is given than a
    /// body farther away than this takes, it never does.
    bool binds(double protrusion) const { return parts || spheres || clearance < 3 * (protrusion + halfGap); }

    /// The largest radius that a sphere about the centre may have. inner: radius d of the ball inside the
    /// body.
    double largestRadius(const Vec3& centre, double inner) const;

    /// The largest r <= longest for which the ball about p - r n through p leaves the other body so much room
    /// that a sphere about its centre may stick out by `protrusion`, or by most of what is allowed at p
    /// itself. n of unit length.
    double shrunkBall(const Vec3& p, const Vec3& n, double longest, double protrusion) const;
};

} // namespace tss
