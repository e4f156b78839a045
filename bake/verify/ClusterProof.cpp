#include "bake/verify/KernelProofs.h"

#include <fmt/format.h>

namespace tss::verify {

namespace {

/// Whether each of some pairs, `each` after the other in that order, is within its bound, and the kernel's
/// rounding about the bound hides none of them.
std::string refuteBounds(const PreparedTable& prepared, const std::vector<Exact>& pairs,
                         std::span<const std::uint32_t> order, std::size_t each,
                         std::span<const TablePair> bounds, const TableKernels::BoundRows& stored,
                         double posed) {
    if (each == 0 || each % prepared.kernels().lanes() != 0 ||
        bounds.size() != (pairs.size() + each - 1) / each)
        return "its clusters do not hold every test once";
    if (!blocksAreRows(prepared, stored.blocks, stored.rows, bounds.size()))
        return "its blocks do not hold every bound of a cluster once";
    for (std::size_t place = 0; place < pairs.size(); ++place) {
        const TablePair& bound = bounds[place / each];
        const std::size_t number = order.empty() ? place : order[place];
        const Exact& pair = pairs[number];
        const Real off = (pair.a.cast<Real>() - bound.a.cast<Real>()).norm() +
                         (pair.b.cast<Real>() - bound.b.cast<Real>()).norm();
        if (off + Real(pair.contactDistance) > Real(bound.contactDistance))
            return fmt::format("cluster {} has number {}, which its bound does not hold", place / each,
                               number);
    }
    for (std::size_t c = 0; c < bounds.size(); ++c) {
        const Exact bound{bounds[c].a, bounds[c].b, bounds[c].contactDistance};
        const PairErrors errors = directErrors(prepared, StoredRow(prepared, stored.rows, c), bound,
                                               prepared.kernels().farthestT(), posed);
        if (errors.sign.high > 0 && bound.contactDistance >= 0)
            return fmt::format("cluster {} may be passed over where a test of it touches", c);
    }
    return {};
}

} // namespace

std::string refuteClusters(const PreparedTable& prepared, const std::vector<Exact>& tests, double posed) {
    const TableClusters& clusters = prepared.kernels().clusters();
    if (clusters.empty()) return {};
    const std::vector<std::uint32_t>& order = clusters.order();
    if (order.size() != tests.size() || clusters.levels().back().size() > TableClusters::mostAtTop ||
        clusters.ofGroup() > TableClusters::mostAtTop)
        return "its clusters do not hold every test once";
    std::vector<Exact> below = tests;
    for (std::size_t level = 0; level < clusters.levels().size(); ++level) {
        const std::vector<TablePair>& bounds = clusters.levels()[level];
        const std::string reason =
            refuteBounds(prepared, below, level == 0 ? std::span(order) : std::span<const std::uint32_t>(),
                         level == 0 ? clusters.testsEach() : clusters.ofGroup(), bounds,
                         prepared.kernels().boundsOf(level), posed);
        if (!reason.empty()) return fmt::format("level {} of its clusters: {}", level, reason);
        below.clear();
        for (const TablePair& bound : bounds) below.push_back({bound.a, bound.b, bound.contactDistance});
    }
    // What is asked first, which alone may say that a pose touches, is tests of the table.
    const std::vector<std::uint32_t>& likely = prepared.kernels().likely();
    const TableKernels::BoundRows stored = prepared.kernels().likelyTests();
    if (!blocksAreRows(prepared, stored.blocks, stored.rows, likely.size()) ||
        !rowsAreTests(prepared, stored.rows, likely))
        return "what it asks first is no test of it";
    return {};
}

} // namespace tss::verify
