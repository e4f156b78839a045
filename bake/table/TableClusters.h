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
/// near one another in both bodies, clusters in groups, and these in groups again until few are left
/// (METHOD 4). Each is bounded by one pair of spheres: where these two are apart by some margin all of its
/// tests are. For tables over many DOFs, whose limits are too wide for cells.
class TableClusters {
public:
    /// At most so many groups of the last level, and so many of a level in one of the next unless a vector
    /// has more lanes: a query lists those of one without allocating.
    static constexpr std::uint32_t mostAtTop = 256, mostOfGroup = 16;

    TableClusters() = default;
    TableClusters(std::span<const TablePair> pairs, std::uint32_t lanes);

    bool empty() const { return levels_.empty(); }
    std::size_t count() const { return levels_.empty() ? 0 : levels_[0].size(); }

    /// The tests as the blocks hold them: those of cluster c stand from c * testsEach() on.
    const std::vector<std::uint32_t>& order() const { return order_; }
    std::size_t testsEach() const { return testsEach_; }

    /// Level 0: the pair that bounds each cluster from below (boundOf()). Of each level above, number g
    /// bounds those of the level below from g * ofGroup() on, whole blocks of them too.
    std::span<const std::vector<TablePair>> levels() const { return levels_; }
    std::size_t ofGroup() const { return ofGroup_; }

private:
    std::vector<std::uint32_t> order_;
    std::vector<std::vector<TablePair>> levels_;
    std::size_t testsEach_ = 0, ofGroup_ = 0;
};

} // namespace tss
