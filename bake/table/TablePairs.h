#pragma once
#include "bake/table/Table.h"

namespace tss {

/// One test, flat: what kernels are made from.
struct TablePair {
    Vec3 a, b; ///< centres, each in its own body's frame
    double radiusA = 0, radiusB = 0;
    double contactDistance = 0; ///< distance of the centres at contact: radiusA + radiusB + rest gap
};

/// In the order of the tests.
std::vector<TablePair> tablePairs(const Table& table);

/// Distance of the centres at a pose.
inline double centreDistance(const TablePair& pair, const Pose& pose) {
    return (pose * pair.b - pair.a).norm();
}

/// Poses spread evenly over the limits by a lattice, the same ones every time: `count` by #DOFs.
std::vector<std::vector<double>> latticePoses(const Motion& motion, int count);

} // namespace tss
