// After the shrinking ball of Ma, Bae and Choi, "3D medial axis point approximation using nearest neighbors
// and the normal field", 2012, with the exact distance from the mesh in place of sampled points.
#include "bake/spheres/MedialBall.h"

#include <algorithm>

namespace tss {

double largestBall(const MeshQuery& boundary, const Vec3& p, const Vec3& n, double slack, double longest,
                   double hint) {
    double r = hint > 0 ? std::min(hint, longest) : longest;
    bool shrunk = false;
    for (int round = 0; round < 100; ++round) {
        if (r <= slack) return r; // no point can be in the way of so small a ball
        const ClosestPoint near = boundary.closest(p - r * n, r - slack);
        if (near.triangle < 0) {
            if (shrunk || r >= longest) return r;
            r = std::min(2 * r, longest);
            continue;
        }
        shrunk = true;
        // The ball that reaches `slack` through the point in the way; the largest one is no larger.
        const Vec3 v = p - near.point;
        const double next = (v.squaredNorm() - slack * slack) / (2 * (v.dot(n) - slack));
        // Not below slack, where nothing is in the way; a little less each time, so that rounding cannot hold
        // it.
        r = std::max(slack, std::min(next, r * (1 - 1e-9)));
    }
    return 0;
}

namespace {

bool inside(const Solid& solid, const Vec3& p, const KnownInside& known) {
    if ((p - known.centre).squaredNorm() < known.radius * known.radius * (1 - 1e-9)) return true;
    return solid.inside(p);
}

} // namespace

MedialBall medialBall(const Solid& solid, const Vec3& p, const Vec3& n, double protrusion, double slackFactor,
                      double hint, KnownInside& known, const RestNeighbour* neighbour) {
    // How far a sphere may stick out about a centre with an inscribed ball of radius `inner`.
    const auto allowed = [&](const Vec3& centre, double inner) {
        return neighbour ? std::min(protrusion, neighbour->largestRadius(centre, inner) - inner) : protrusion;
    };
    const MedialBall onSurface{{p, allowed(p, 0)}, 0, 0};
    if (solid.hollow()) return onSurface;
    const double longest = solid.diagonal() / 2;
    double slack = slackFactor * protrusion;
    // Up to three attempts, each with a 32nd of the slack. One whose slack is too coarse for what the
    // neighbour lets the sphere stick out does not count: it is repeated with the slack for that, at most
    // four times.
    for (int attempt = 0, finer = 0; attempt < 3; ++attempt, slack /= 32) {
        // A misoriented triangle has its inside on the other side.
        for (const Vec3& direction : {n, Vec3(-n)}) {
            const double unconstrained =
                largestBall(solid.boundary(), p, direction, slack, longest, attempt == 0 ? hint : 0);
            const double r =
                neighbour ? neighbour->shrunkBall(p, direction, unconstrained, protrusion) : unconstrained;
            if (!(r > 0)) continue;
            const Vec3 centre = p - r * direction;
            const double distance = solid.boundary().distance(centre, 2 * r);
            // On the surface itself rounding decides the side, and the ball about p does as well.
            if (distance <= 1e-6 * protrusion || r - distance > 2 * slack) continue;
            if (!inside(solid, centre, known)) continue;
            const double beyond = allowed(centre, distance);
            if (!(beyond > 0)) continue;
            if (slack > 5 * slackFactor * beyond && finer < 4) {
                slack = 32 * slackFactor * beyond; // the loop divides it by 32
                --attempt, ++finer;
                break;
            }
            known = {centre, distance};
            return {{centre, distance + beyond}, distance, unconstrained};
        }
    }
    return onSurface;
}

} // namespace tss
