#pragma once
#include "bake/geometry/TriangleMesh.h"

namespace tss {

/// The fibre line of a muscle that closes on itself, as about mouth and eye: a smooth closed curve over its
/// own plane. The parameter of a point is the turn about the ring's middle, from 0 at the first point of the
/// line to 1 where it comes round, so that it does not jump where the line bends.
class MuscleRing {
public:
    /// points: at least 3, once round their middle in one direction, or InputError.
    explicit MuscleRing(const std::vector<Vec3>& points);

    double parameter(const Vec3& x) const; ///< in [0, 1)
    Vec3 point(double s) const;            ///< its own parameter is s
    /// From the ring's axis, which stands upright on its plane, to point(s): what narrowing shortens.
    Vec3 spoke(double s) const;

    /// How far a point lies from the axis on the side of point(s).
    double outward(const Vec3& x, double s) const { return along(s).dot(x - middle_); }

private:
    struct Knot {
        double s;
        double radius, height;           ///< from the axis, and above the plane
        double radiusSlope, heightSlope; ///< per s
    };
    struct Place {
        double radius, height;
    };
    Place place(double s) const;
    Vec3 along(double s) const; ///< unit, from the axis

    Vec3 middle_, x_, y_, axis_; ///< y_ a quarter turn after x_
    std::vector<Knot> knots_;    ///< rising from 0; the last one is the first, at 1
};

} // namespace tss
