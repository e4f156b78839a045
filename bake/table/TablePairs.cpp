#include "bake/table/TablePairs.h"

#include <cmath>

namespace tss {

std::vector<TablePair> tablePairs(const Table& table) {
    std::vector<TablePair> pairs;
    const std::vector<SpherePair> list = tests(table);
    for (std::size_t k = 0; k < list.size(); ++k) {
        const Sphere &a = table.a[list[k].a], &b = table.b[list[k].b];
        const double rest = table.restGaps.empty() ? 0 : table.restGaps[k];
        pairs.push_back({a.centre, b.centre, a.radius, b.radius, a.radius + b.radius + rest});
    }
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
