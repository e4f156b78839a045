#include "bake/motion/SmallSystems.h"

#include <Eigen/SVD>

namespace tss {

SingularValues singularValues(const Eigen::Matrix3d& matrix) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return {svd.matrixU(), svd.matrixV(), svd.singularValues()};
}

} // namespace tss
