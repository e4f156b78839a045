#pragma once
#include "bake/spheres/SphereSet.h"

#include <span>

namespace tss::compare {

/// How a ball about balls is found.
enum class Enclosure {
    Box,     ///< centre of the bounding box: what is cheapest to build
    Points,  ///< minimal ball of the centres (Welzl 1991; CGAL Min_sphere_d), grown by the largest radius
    Balls,   ///< minimal ball of the balls (Fischer and Gaertner 2003; CGAL Min_sphere_of_spheres_d)
    CoreSet, ///< (1 + eps) approximation by farthest balls (Badoiu and Clarkson 2003)
};

/// A ball that contains all the balls given, at least one. The radius is made good in double, so that it does
/// contain them whatever the arithmetic before did.
Sphere enclosingBall(std::span<const Sphere> balls, Enclosure how);

/// The core-set approximation: the radius is at most (1 + eps) times the least, eps in (0, 1).
Sphere coreSetBall(std::span<const Sphere> balls, double eps);

} // namespace tss::compare
