#pragma once
#include "bake/table/TablePairs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// A pair of spheres that bounds some pairs from below: at every pose its gap, the distance of its centres
/// less its contact distance, is at most the gap of each of them. Its radii are not told apart, only their
/// sum in contact distance.
TablePair boundOf(std::span<const TablePair> pairs);

/// The tests of a large table in clusters of equally many whole blocks, those together whose spheres lie
/// near one another in both bodies, and clusters in groups (METHOD 4). Each is bounded by one pair of
/// spheres: where these two are apart by some margin all of its tests are. For tables over many DOFs, whose
/// limits are too wide for cells.
class TableClusters {
public:
    /// At most so many clusters, and so many in a group unless a vector has more lanes: a query lists groups,
    /// and the clusters of one, without allocating.
    static constexpr std::uint32_t most = 4096, mostOfGroup = 16;

    TableClusters() = default;
    TableClusters(std::span<const TablePair> pairs, std::uint32_t lanes);

    bool empty() const { return bounds_.empty(); }
    std::size_t count() const { return bounds_.size(); }

    /// The tests as the blocks hold them: those of cluster c stand from c * testsEach() on.
    const std::vector<std::uint32_t>& order() const { return order_; }
    std::size_t testsEach() const { return testsEach_; }

    /// The pair that bounds each cluster from below (boundOf()).
    std::span<const TablePair> bounds() const { return bounds_; }

    /// Group g is the clusters from g * clustersEach() on, whole blocks of them too; bounded likewise.
    std::size_t clustersEach() const { return clustersEach_; }
    std::span<const TablePair> groups() const { return groups_; }

private:
    std::vector<std::uint32_t> order_;
    std::vector<TablePair> bounds_, groups_;
    std::size_t testsEach_ = 0, clustersEach_ = 0;
};

} // namespace tss
