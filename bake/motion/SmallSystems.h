#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace tss {

// Eigen's decompositions of small matrices, compiled once: each source that spells one out takes seconds
// longer.

/// Unit eigenvectors of a symmetric matrix as columns, by ascending eigenvalue.
Eigen::Matrix3d symmetricAxes(const Eigen::Matrix3d& matrix);
Eigen::Matrix4d symmetricAxes(const Eigen::Matrix4d& matrix);

/// matrix = u * diagonal of values * v^T, u and v orthogonal, values from the largest.
struct SingularValues {
    Eigen::Matrix3d u, v;
    Eigen::Vector3d values;
};
SingularValues singularValues(const Eigen::Matrix3d& matrix);

/// Minimum-norm least-squares solution of matrix * x = right; the matrix may be singular.
Eigen::Matrix<double, 6, 1> leastSolution(const Eigen::Matrix<double, 6, 6>& matrix,
                                          const Eigen::Matrix<double, 6, 1>& right);

/// The smallest rotation that takes the direction of one vector to that of the other, neither of them zero;
/// of opposite ones a half turn about some axis. Accurate to rounding also for nearly opposite vectors, for
/// which Eigen's FromTwoVectors is off by up to 1e-5 and not of unit length, and without its header's SVD.
Eigen::Quaterniond turnBetween(const Vec3& from, const Vec3& to);

} // namespace tss
