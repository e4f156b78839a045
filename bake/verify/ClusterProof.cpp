#include "bake/verify/ClusterProof.h"

#include "bake/verify/KernelCells.h"

#include <fmt/format.h>

namespace tss::verify {

std::string refuteClusters(const PreparedTable& prepared, const std::vector<Exact>& tests, double posed) {
    const TableClusters& clusters = prepared.clusters();
    if (clusters.empty()) return {};
    const std::vector<std::uint32_t>& order = clusters.order();
    const std::size_t each = clusters.testsEach();
    if (each == 0 || each % prepared.lanes() != 0 || order.size() != tests.size() ||
        clusters.count() != (tests.size() + each - 1) / each || clusters.count() > TableClusters::most)
        return "its clusters do not hold every test once";
    if (!blocksAreRows(prepared, prepared.clusterBlocks(), prepared.clusterRows(), clusters.count(), {}))
        return "its blocks do not hold every cluster once";
    for (std::size_t place = 0; place < order.size(); ++place) {
        const TablePair& bound = clusters.bounds()[place / each];
        const Exact& test = tests[order[place]];
        const Real off = (test.a.cast<Real>() - bound.a.cast<Real>()).norm() +
                         (test.b.cast<Real>() - bound.b.cast<Real>()).norm();
        if (off + Real(test.reach) > Real(bound.reach))
            return fmt::format("cluster {} has test {}, which its bound does not hold", place / each,
                               order[place]);
    }
    for (std::size_t c = 0; c < clusters.count(); ++c) {
        const TablePair& bound = clusters.bounds()[c];
        const Exact pair{bound.a, bound.b, bound.reach};
        const PairErrors errors = directErrors(prepared, StoredRow(prepared, prepared.clusterRows(), c), pair,
                                               prepared.farthestT(), posed);
        if (errors.sign.high > 0 && bound.reach >= 0)
            return fmt::format("cluster {} may be passed over where a test of it touches", c);
    }
    return {};
}

} // namespace tss::verify
