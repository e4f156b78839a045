#include "bake/table/TablePairs.h"

#include <cmath>

namespace tss {

TableTests::TableTests(const Table& table)
    : a_(table.a), b_(table.b), spheres_(tests(table)), restGaps_(table.restGaps) {}

TablePair TableTests::operator[](std::size_t test) const {
    const Sphere &a = a_[spheres_[test].a], &b = b_[spheres_[test].b];
    return {a.centre, b.centre, a.radius, b.radius, a.radius + b.radius + restGap(test)};
}

std::vector<TablePair> tablePairs(const Table& table) {
    const TableTests tests(table);
    std::vector<TablePair> pairs;
    pairs.reserve(tests.size());
    for (std::size_t k = 0; k < tests.size(); ++k) pairs.push_back(tests[k]);
    return pairs;
}

std::vector<std::vector<double>> latticePoses(const Motion& motion, int count) {
    // Roberts' generalised golden ratio: the root of x^(d+1) = x + 1 and its powers.
    const std::size_t d = motion.dofCount();
    double g = 2;
    for (int i = 0; i < 60; ++i) g = std::pow(1 + g, 1.0 / double(d + 1));
    std::vector<std::vector<double>> poses;
    for (int i = 0; i < count; ++i) {
        std::vector<double> q;
        for (std::size_t k = 0; k < d; ++k) {
            const double x = 0.5 + (i + 1) * std::pow(g, -double(k + 1));
            q.push_back(motion.dofs[k].lower +
                        (x - std::floor(x)) * (motion.dofs[k].upper - motion.dofs[k].lower));
        }
        poses.push_back(q);
    }
    return poses;
}

} // namespace tss
