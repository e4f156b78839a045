#include "bake/motion/SmallSystems.h"

#include <Eigen/Eigenvalues>

namespace tss {

Eigen::Matrix3d symmetricAxes(const Eigen::Matrix3d& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(matrix).eigenvectors();
}

Eigen::Matrix4d symmetricAxes(const Eigen::Matrix4d& matrix) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(matrix).eigenvectors();
}

} // namespace tss
