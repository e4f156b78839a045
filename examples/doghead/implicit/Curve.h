#pragma once
#include "examples/doghead/implicit/Field.h"

#include <vector>

namespace doghead {

/// A function of one value through given points: cubic, and monotone wherever the points are, so that it
/// makes no waves of its own (Fritsch and Carlson). Constant outside.
class Profile {
public:
    struct Knot {
        double at;
        double value;
    };
    explicit Profile(std::vector<Knot> knots); ///< `at` strictly rising, at least two

    double operator()(double at) const;
    double slope(double at) const;

private:
    std::vector<Knot> knots_;
    std::vector<double> slopes_;
};

/// A station of a swept solid: an elliptic section with a half-thickness across and a half-height along the
/// sweep's up direction.
struct Station {
    Vec3 centre;
    double across;
    double along;
};

/// An elliptic section swept along a smooth curve through the stations (Catmull-Rom). `up` is brought square
/// to the curve at every place and must not lie along it unless the sections are round; the ends are rounded
/// off.
Field sweep(const std::vector<Station>& stations, const Vec3& up);

/// The same with a section of two parallel sides and round rims (across <= along): for ridges and arches,
/// whose edges an ellipse would make too sharp.
Field ribbon(const std::vector<Station>& stations, const Vec3& up);

/// A round tube through points with radii.
Field tube(const std::vector<Vec3>& points, const std::vector<double>& radii);

/// A smooth closed curve through the corners, as a polygon with `steps` sides between every two.
using Outline = std::vector<Eigen::Vector2d>;
Outline smoothOutline(const Outline& corners, int steps);

/// Signed distance in the plane to a closed polygon, negative inside.
double outlineDistance(const Outline& polygon, const Eigen::Vector2d& p);

/// A plate: a closed outline in the x-z plane (smooth through its corners), given half-thickness, lying in
/// the surface y = level + slopeX x + slopeZ z, its rim rounded.
struct PlateShape {
    Outline outline;
    double level;
    double slopeX;
    double slopeZ;
    double halfThickness;
};
Field plate(const PlateShape& shape);

} // namespace doghead
