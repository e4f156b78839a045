#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tss {

using Pose = Eigen::Isometry3d;

/// Whether a pose is exactly the identity.
inline bool isIdentity(const Pose& pose) {
    return pose.matrix() == Pose::Identity().matrix();
}

enum class DofKind { Rotation, Translation, Path };

/// One row of a path: the rigid pose at a value. Between rows: linear in translation, slerp in rotation.
struct PathRow {
    double value = 0;
    Vec3 translation = Vec3::Zero();
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

/// One degree of freedom D(q), a rigid map in the frame of body A.
///   Rotation:    D(x) = R(axis, q)(x - origin) + origin, axis of unit length, q in radians
///   Translation: D(x) = x + q * axis, axis of any length, q in multiples of it
///   Path:        D(x) = frame * path(q) * frame^-1 x
struct Dof {
    std::string name;
    DofKind kind = DofKind::Rotation;
    Vec3 origin = Vec3::Zero(); ///< a point on the axis (rotation)
    Vec3 axis = Vec3::UnitX();
    double lower = 0; ///< lower <= upper, finite
    double upper = 0;
    double rest = 0;           ///< value at rest: motions start there, overlap of the bodies there is allowed
    std::vector<PathRow> path; ///< at least two rows, values strictly rising, covering [lower, upper]
    Pose frame = Pose::Identity();
};

/// A linear coupling of limits: coefficients . q <= bound.
struct LimitPlane {
    std::vector<double> coefficients; ///< one per DOF
    double bound = 0;
};

/// By how much q violates a plane, in the plane's own unit; at most 0 where it holds. q: one value per DOF.
inline double excess(const LimitPlane& plane, std::span<const double> q) {
    double sum = -plane.bound;
    for (std::size_t k = 0; k < q.size(); ++k) sum += plane.coefficients[k] * q[k];
    return sum;
}

/// The longest chain that is served: a finger and the thigh of a figure whose bones turn about three axes.
inline constexpr std::size_t maxDofs = 32;

/// Values or changes of DOFs, room for the longest chain.
using DofValues = std::array<double, maxDofs>;

/// How body B may move against body A: T(q) = D1(q1) ... Dd(qd) T0, B-local to A-local (METHOD 0).
/// Q is the box of the DOFs' limits cut by the planes.
struct Motion {
    std::vector<Dof> dofs;        ///< D1, nearest to A, first
    Pose base = Pose::Identity(); ///< T0
    std::vector<LimitPlane> planes;

    std::size_t dofCount() const { return dofs.size(); }
};

/// The rigid map of one DOF at value q.
Pose dofPose(const Dof& dof, double q);

/// T(q). q: one value per DOF.
Pose pose(const Motion& motion, std::span<const double> q);

/// The rest values of all DOFs.
std::vector<double> restValues(const Motion& motion);

/// Throws InputError unless there is one value a DOF.
void expectValues(const Motion& motion, std::span<const double> q);

/// Every limit and every plane holds at q, with a slack in the DOF's own unit.
bool withinLimits(const Motion& motion, std::span<const double> q, double slack = 0);

/// Some value violates its limits or a plane by more than rounding to float in a file explains, or is not
/// finite, or there is not one a DOF.
bool beyondLimits(const Motion& motion, std::span<const double> q);

/// Clamps each DOF into its limits, then pulls q back into the planes by cyclic projection (at most 10000
/// rounds; the result is inside for a non-empty Q up to 1e-12 of the range).
std::vector<double> clampToLimits(const Motion& motion, std::span<const double> q);

/// DOF values uniformly over the limits, from a seed; those outside the limit planes are drawn again. May
/// give fewer where the planes leave next to nothing.
std::vector<std::vector<double>> randomPoses(const Motion& motion, std::size_t count, std::uint64_t seed);

/// Throws InputError for a motion that cannot be served: no finite limits, reversed limits, zero axis, bad
/// path, limits and planes that leave no pose or not the rest.
void checkMotion(const Motion& motion);

} // namespace tss
