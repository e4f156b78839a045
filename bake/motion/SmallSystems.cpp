#include "bake/motion/SmallSystems.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace tss {

Eigen::Matrix3d symmetricAxes(const Eigen::Matrix3d& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvectors();
}

Eigen::Matrix4d symmetricAxes(const Eigen::Matrix4d& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(matrix).eigenvectors();
}

SingularValues singularValues(const Eigen::Matrix3d& matrix) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

Eigen::Matrix<double, 6, 1> leastSolution(const Eigen::Matrix<double, 6, 6>& matrix,
                                          const Eigen::Matrix<double, 6, 1>& right) {
    return matrix.completeOrthogonalDecomposition().solve(right);
}

} // namespace tss
