#pragma once
#include "bake/table/Table.h"
#include "bake/table/TablePairs.h"

namespace tss {

struct QueryResult {
    double gap = 0; ///< smallest gap minus its rest gap, scene units; <= 0: contact. +inf for an empty table
    int test = -1;  ///< index of the test that gives it, -1 for an empty table
    Vec3 point = Vec3::Zero();  ///< contact point in A's frame, half way between the two sphere surfaces
    Vec3 normal = Vec3::Zero(); ///< unit, A's frame, from A towards B
    bool hit() const { return gap <= 0; }
};

/// The plain query: every test of the table at pose T(q), in double. METHOD 4 without the fold. Throws
/// InputError for values that are not finite or not one a DOF.
QueryResult query(const Table& table, const Pose& pose);
QueryResult query(const Table& table, std::span<const double> q);

/// Whether query() at the pose has a hit: no farther than the first test that touches.
bool touches(const Table& table, const Pose& pose);

/// The gap of one test, to the bit as the plain query has it. inverse: of the pose.
double queryGap(const TableTests& tests, std::uint32_t test, const Pose& inverse);

/// The plain query of tests, of all or of some alone.
QueryResult query(const TableTests& tests, const Pose& pose);
QueryResult query(const TableTests& tests, const Pose& pose, std::span<const std::uint32_t> some);

/// The same over every pair of two whole sphere sets, the reference that tables are judged against.
QueryResult queryAllPairs(const SphereSet& a, const SphereSet& b, const Pose& pose);

} // namespace tss
