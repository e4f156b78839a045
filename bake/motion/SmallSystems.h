#pragma once
#include <Eigen/Core>

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

} // namespace tss
