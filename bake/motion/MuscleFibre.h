#pragma once
#include "bake/geometry/TriangleMesh.h"

namespace tss {

/// The fibre line of a muscle as a smooth curve over its chord (METHOD 6.1). The parameter of a point is its
/// projection on the chord: 0 at the origin, 1 at the insertion, and it goes on beyond both; the closest
/// point of a polyline would jump where the line bends.
class MuscleFibre {
public:
    /// points: at least 2 and origin != insertion, or InputError. A point that lies no farther along the
    /// chord than the one before it is left out.
    explicit MuscleFibre(const std::vector<Vec3>& points);

    double parameter(const Vec3& x) const { return (x - origin_).dot(direction_) / chord_; }
    Vec3 point(double s) const; ///< its own parameter is s; straight beyond the ends

private:
    struct Knot {
        double s;
        Vec3 side;  ///< from the chord to the curve
        Vec3 slope; ///< d side / ds
    };
    Vec3 origin_, direction_; ///< of the chord; direction_ unit, towards the insertion
    double chord_ = 0;        ///< its length, scene units
    std::vector<Knot> knots_;
};

/// Whether a polyline advances along its chord from each point to the next. MuscleFibre leaves out the points
/// of one that does not, as of a muscle that winds by more than half a turn.
bool goesOnAlongChord(const std::vector<Vec3>& points);

/// How the shortening spreads along the fibre: a bump with smooth ends on [0, 1] and an integral of 1.
double contractionBump(double s);
/// Its integral from 0: 0 before the origin, 1 beyond the insertion.
double contractionIntegral(double s);
/// The largest value of the bump.
double contractionPeak();

} // namespace tss
