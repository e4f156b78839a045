// Welzl, "Smallest enclosing disks (balls and ellipsoids)", 1991; Fischer and Gaertner, "The smallest
// enclosing ball of balls", 2003; Badoiu and Clarkson, "Smaller core-sets for balls", 2003.
#include "bake/compare/MinBall.h"

#include <CGAL/Cartesian.h>
#include <CGAL/Min_sphere_annulus_d_traits_3.h>
#include <CGAL/Min_sphere_d.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Min_sphere_of_spheres_d_traits_3.h>
#include <cmath>

namespace tss::compare {

namespace {

using Kernel = CGAL::Cartesian<double>;
using Point = Kernel::Point_3;
using BallTraits = CGAL::Min_sphere_of_spheres_d_traits_3<Kernel, double>;

/// The least ball about this centre.
Sphere about(const Vec3& centre, std::span<const Sphere> balls) {
    double radius = 0;
    for (const Sphere& ball : balls) radius = std::max(radius, (ball.centre - centre).norm() + ball.radius);
    return {centre, balls.size() == 1 ? balls[0].radius : radius * (1 + 1e-15)};
}

Vec3 boxCentre(std::span<const Sphere> balls) {
    Eigen::AlignedBox3d box;
    for (const Sphere& ball : balls) {
        box.extend(Vec3(ball.centre.array() - ball.radius));
        box.extend(Vec3(ball.centre.array() + ball.radius));
    }
    return box.center();
}

/// Welzl's algorithm is meant for exact arithmetic: in doubles a degenerate set can give no centre, and then
/// that of the box has to do.
Vec3 pointsCentre(std::span<const Sphere> balls) {
    std::vector<Point> points;
    for (const Sphere& ball : balls) points.emplace_back(ball.centre.x(), ball.centre.y(), ball.centre.z());
    using Traits = CGAL::Min_sphere_annulus_d_traits_3<Kernel>;
    const CGAL::Min_sphere_d<Traits> least(points.begin(), points.end());
    const Vec3 centre(least.center().x(), least.center().y(), least.center().z());
    return centre.allFinite() ? centre : boxCentre(balls);
}

Vec3 ballsCentre(std::span<const Sphere> balls) {
    std::vector<BallTraits::Sphere> spheres;
    for (const Sphere& ball : balls)
        spheres.emplace_back(Point(ball.centre.x(), ball.centre.y(), ball.centre.z()), ball.radius);
    CGAL::Min_sphere_of_spheres_d<BallTraits> least(spheres.begin(), spheres.end());
    const auto* c = least.center_cartesian_begin();
    return {c[0], c[1], c[2]};
}

} // namespace

Sphere coreSetBall(std::span<const Sphere> balls, double eps) {
    // Frank-Wolfe on the farthest ball: after 1/eps^2 steps of length 1/(k + 1) the centre is within eps R.
    Vec3 centre = balls[0].centre;
    const int rounds = static_cast<int>(std::ceil(1 / (eps * eps)));
    for (int k = 1; k <= rounds; ++k) {
        double farthest = -1;
        Vec3 point = centre;
        for (const Sphere& ball : balls) {
            const Vec3 away = ball.centre - centre;
            const double distance = away.norm();
            if (distance + ball.radius <= farthest) continue;
            farthest = distance + ball.radius;
            point = distance > 0 ? Vec3(ball.centre + away * (ball.radius / distance))
                                 : Vec3(ball.centre + Vec3(ball.radius, 0, 0));
        }
        centre += (point - centre) / (k + 1);
    }
    return about(centre, balls);
}

Sphere enclosingBall(std::span<const Sphere> balls, Enclosure how) {
    if (balls.size() == 1) return balls[0];
    switch (how) {
    case Enclosure::Points:
        return about(pointsCentre(balls), balls);
    case Enclosure::Balls:
        return about(ballsCentre(balls), balls);
    case Enclosure::CoreSet:
        return coreSetBall(balls, 0.1);
    case Enclosure::Box:
        break;
    }
    return about(boxCentre(balls), balls);
}

} // namespace tss::compare
