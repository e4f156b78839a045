#pragma once
#include "bake/motion/Motion.h"

#include <functional>
#include <vector>

namespace doghead {

using tss::Pose;
using tss::Vec3;
using Box = Eigen::AlignedBox3d;

/// A solid as a function: about the signed distance to its surface, in millimetres, negative inside. Near the
/// surface it is good to a few per cent, far away its sign and order of magnitude are right.
struct Field {
    std::function<double(const Vec3&)> distance;
    Box box; ///< contains the solid

    double operator()(const Vec3& p) const { return distance(p); }
};

/// Unit gradient by central differences of 2h.
Vec3 normal(const Field& field, const Vec3& p, double h = 0.05);

/// An axis-aligned ellipsoid.
Field ellipsoid(const Vec3& centre, const Vec3& radii);

/// A ball of radius ra at a, one of radius rb at b, and the cone that touches both (exact).
Field cone(const Vec3& a, const Vec3& b, double ra, double rb);

/// The solid moved by a rigid map.
Field placed(const Field& field, const Pose& pose);

/// Turned by degrees about an axis through a point.
Field turned(const Field& field, const Vec3& centre, const Vec3& axis, double degrees);

/// Scaled about a centre; the distance is scaled by the smallest factor, so that it stays a lower bound.
Field stretched(const Field& field, const Vec3& centre, const Vec3& factors);

/// Grown outwards by an amount (shrunk when negative).
Field grown(const Field& field, double amount);

/// The half-space behind the plane through a point, within a box.
Field halfSpace(const Vec3& point, const Vec3& outward, const Box& box);

/// Left and right alike: the given solid at +y and its mirror image, evaluated on |y|. The solid should cross
/// the plane y = 0 at right angles or not at all.
Field mirrored(const Field& field);

/// Minimum of two distances with a blend of width k: they differ from min() only where |a - b| < k.
double smoothMin(double a, double b, double k);

/// A solid built step by step. Each step blends over a width k, 0 for a sharp edge; steps far from the point
/// asked for are skipped by their boxes.
class Sculpture {
public:
    Sculpture& add(const Field& part, double k = 0);
    Sculpture& carve(const Field& part, double k = 0);
    Sculpture& keep(const Field& part, double k = 0); ///< intersection

    Field field() const;

private:
    enum class Kind { Add, Carve, Keep };
    struct Step {
        Kind kind;
        Field part;
        double k;
    };
    std::vector<Step> steps_;
};

} // namespace doghead
