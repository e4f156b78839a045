#pragma once
#include "bake/table/TablePairs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace tss {

/// A bounding pair of spheres: at every pose its gap, the distance of its centres less its contact distance,
/// is at most the gap of each of the given pairs. Only its contact distance is set, the sum of both radii,
/// not the radii themselves.
TablePair boundOf(std::span<const TablePair> pairs);

/// A bounding hierarchy over the tests of a large table (METHOD 4). Tests whose spheres lie near one another
/// in both bodies make a cluster, all of the same number of whole blocks; clusters make groups, and groups
/// larger groups until few are left. Each has a bounding pair: where that is apart by some margin, so are
/// all tests below. For tables over many DOFs, whose limits are too wide for cells.
class TableClusters {
public:
    /// The most groups of the top level, and the most members of a group (more where a vector has more
    /// lanes): few enough for a query to list without allocating.
    static constexpr std::uint32_t mostAtTop = 256, mostOfGroup = 16;

    TableClusters() = default;
    TableClusters(std::span<const TablePair> pairs, std::uint32_t lanes);

    bool empty() const { return levels_.empty(); }
    std::size_t count() const { return levels_.empty() ? 0 : levels_[0].size(); }

    /// The tests as the blocks hold them: those of cluster c stand from c * testsEach() on.
    const std::vector<std::uint32_t>& order() const { return order_; }
    std::size_t testsEach() const { return testsEach_; }

    /// Bounding pairs (boundOf()), level 0 of the clusters. Pair g of a level above bounds the ofGroup()
    /// pairs from g * ofGroup() on of the level below, which are whole blocks too.
    std::span<const std::vector<TablePair>> levels() const { return levels_; }
    std::size_t ofGroup() const { return ofGroup_; }

private:
    std::vector<std::uint32_t> order_;
    std::vector<std::vector<TablePair>> levels_;
    std::size_t testsEach_ = 0, ofGroup_ = 0;
};

} // namespace tss
