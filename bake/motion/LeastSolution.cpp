#include "bake/motion/SmallSystems.h"

#include <Eigen/QR>

namespace tss {

Eigen::Matrix<double, 6, 1> leastSolution(const Eigen::Matrix<double, 6, 6>& matrix,
                                          const Eigen::Matrix<double, 6, 1>& right) {
    return matrix.completeOrthogonalDecomposition().solve(right);
}

} // namespace tss
