#pragma once
#include "bake/motion/Motion.h"
#include "bake/table/Table.h"

#include <limits>

namespace tss::verify {

using Real = long double;
constexpr Real realRoundoff = std::numeric_limits<Real>::epsilon();
using Vector = Eigen::Matrix<Real, 3, 1>;
using Matrix = Eigen::Matrix<Real, 3, 3>;

/// A rigid pose in extended precision.
struct ExactPose {
    Matrix turn = Matrix::Identity();
    Vector shift = Vector::Zero();
    ExactPose times(const ExactPose& inner) const { return {turn * inner.turn, turn * inner.shift + shift}; }
    Vector at(const Vec3& y) const { return turn * y.cast<Real>() + shift; }
};

/// T(q) in extended precision; of a path as double gives it.
ExactPose exactPose(const Motion& motion, const std::vector<Real>& q);

/// How far a point may come out of T(q) from where it is, when that is worked out with roundoff u: `size`
/// bounds every coordinate on the way.
double poseRounding(const Motion& motion, double size, double u);

/// How far a point comes out of T(q) because how far each turn is from the middle of its limits is itself
/// rounded: nothing beside poseRounding(), unless limits are many turns apart. size: as there.
double turnRounding(const Motion& motion, double size, double u);

/// One test as it stands in the table.
struct Exact {
    Vec3 a, b;
    double contactDistance;
};

/// In the order of the table.
std::vector<Exact> exactTests(const Table& table);

/// A bound for every coordinate that a test's centre meets on its way into A's frame.
double pathSize(const Motion& motion, const std::vector<Exact>& tests);

} // namespace tss::verify
