#pragma once
#include "bake/spheres/SphereSet.h"

#include <cstdint>

namespace tss::compare {

/// An ellipsoid bent along its first axis: the point (x, y, z) of the straight one stands at
/// (x, y + bend x^2, z) in the frame, and the frame's columns and centre place it.
struct BentEllipsoid {
    Vec3 centre = Vec3::Zero();
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity(); ///< columns: the bent axis, towards the bend, across
    Vec3 radii = Vec3::Ones();
    double bend = 0; ///< 1/length; curvature at the middle is 2 bend
};

/// Does the sphere touch the ellipsoid? By the characteristic polynomial f(l) = det(l A + B) of the two
/// quadrics: they are apart exactly when f has two different positive roots (Wang, Wang and Kim 2001), which
/// the Sturm sequence counts without solving. The sphere is first carried into the straight ellipsoid's
/// frame; that it stays a sphere there is the approximation for bent ones, good for bend * radii[0] << 1.
/// products, where given: raised by the products made, divisions counted as one each, as the paper counts.
bool touches(const BentEllipsoid& ellipsoid, const Sphere& sphere, std::uint64_t* products = nullptr);

/// The bent ellipsoid of a mesh: principal axes of its vertices, the bend that fits them best along the
/// longest, and half the extents as radii.
BentEllipsoid fitEllipsoid(const TriangleMesh& mesh);

} // namespace tss::compare
