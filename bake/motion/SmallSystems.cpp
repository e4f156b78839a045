#include "bake/motion/SmallSystems.h"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <cmath>

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

Eigen::Quaterniond turnBetween(const Vec3& from, const Vec3& to) {
    const Vec3 a = from.normalized(), b = to.normalized();
    Vec3 axis = a.cross(b);
    const double cosine = a.dot(b);
    if (cosine >= 0) { // by half of the angle, without a trigonometric function
        const double half = std::sqrt(0.5 * (1 + cosine));
        axis *= 0.5 / half;
        return Eigen::Quaterniond(half, axis.x(), axis.y(), axis.z()).normalized();
    }
    const double sine = axis.norm();
    if (!(sine > 1e-15)) { // opposite
        const Vec3 across = a.unitOrthogonal();
        return {0, across.x(), across.y(), across.z()};
    }
    axis /= sine;
    axis -= axis.dot(a) * a; // of a short one little is right
    return Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(sine, cosine), axis.normalized()));
}

} // namespace tss
