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

/// The tests of a table, each made when it is asked for: a ninth of the memory.
class TableTests {
public:
    explicit TableTests(const Table& table);
    std::size_t size() const { return spheres_.size(); }
    TablePair operator[](std::size_t test) const;
    SpherePair spheres(std::size_t test) const { return spheres_[test]; }
    double restGap(std::size_t test) const { return restGaps_.empty() ? 0 : restGaps_[test]; }

private:
    SphereSet a_, b_;
    std::vector<SpherePair> spheres_; ///< of each test
    std::vector<double> restGaps_;    ///< of each test, or empty
};

/// Distance of the centres at a pose.
inline double centreDistance(const TablePair& pair, const Pose& pose) {
    return (pose * pair.b - pair.a).norm();
}

/// Poses spread evenly over the limits by a lattice, the same ones every time: `count` by #DOFs.
std::vector<std::vector<double>> latticePoses(const Motion& motion, int count);

} // namespace tss
