#pragma once
#include "bake/motion/MotionFrame.h"
#include "bake/table/Kernels.h"
#include "bake/table/TablePairs.h"

#include <algorithm>

namespace tss {

/// The limits of a motion divided into cells, smaller ones where contact begins. For each cell and each block
/// of tests (as the kernels read them) it stores a lower bound of the gaps of the block's tests in the cell
/// (METHOD 4, cells), so that a query skips the blocks that cannot matter where the joint stands.
/// A bound is stored as a code of one byte, which never decreases as the gap grows: a block that
/// matters by its gap also matters by its code.
class TableCells {
public:
    /// The largest code of a gap <= 0.
    static constexpr std::uint8_t contactCode = 64;
    /// Smaller codes are stored in every cell; gaps from here on may be stored as farCode.
    static constexpr std::uint8_t nearCode = 160;
    /// "Farther than what matters": no order between such gaps.
    static constexpr std::uint8_t farCode = 255;
    static constexpr std::uint32_t codesPerGroup = NearBlocks::codesPerGroup;
    static constexpr std::uint32_t headerCodes = NearBlocks::headerCodes;

    TableCells() = default;
    /// Empty where no DOF moves any test. See `order` for what comes where.
    TableCells(const Motion& motion, std::span<const TablePair> pairs, std::uint32_t lanes);

    bool empty() const { return dofs_ == 0; }

    /// The tests in the order in which they make up blocks of `lanes`: those that come near in the same cells
    /// share blocks.
    const std::vector<std::uint32_t>& order() const { return order_; }

    /// The index of the row of codes for the cell that q is in. Beyond the limits it is row 0, by which every
    /// block may touch.
    std::uint32_t rowAt(const double* q) const {
        std::uint32_t cell = 0, part = 0, beyond = 0;
        for (std::size_t k = 0; k < dofs_; ++k) {
            const Axis& axis = axes_[k];
            // Counted from 1; what is beyond the limits, or no number, becomes 0 or more than there are.
            const double x = std::min(std::max(0.0, (q[k] - axis.before) * axis.perWidth), axis.beyond);
            const std::uint32_t i = static_cast<std::uint32_t>(static_cast<std::int32_t>(x)) - 1;
            beyond |= static_cast<std::uint32_t>(i >= axis.parts);
            cell += (i >> axis.halvings) * axis.stride;
            part += (i & axis.partMask) << axis.partShift;
        }
        if (beyond) return 0;
        const GridCell& found = grid_[cell];
        return found.first + (part & found.mask);
    }

    /// The blocks that can hold a gap up to the code `limit` in the cell of that row: limit below nearCode,
    /// or its reachedCode.
    NearBlocks nearBlocks(std::uint32_t row, std::uint8_t limit) const {
        return {rows_.data() + std::size_t(row) * rowCodes_, rowCodes_ / codesPerGroup, limit};
    }
    /// An upper bound of the table's gap all over the cell. farCode: not known.
    std::uint8_t reachedCode(std::uint32_t row) const { return rows_[std::size_t(row) * rowCodes_]; }
    /// Some test touches at every pose of the cell.
    bool allTouch(std::uint32_t row) const { return reachedCode(row) <= contactCode; }
    /// No test touches anywhere in the cell.
    bool noneTouches(std::uint32_t row) const { return nearestCode(row) > contactCode; }
    /// A lower bound of the codes of all gaps in the cell.
    std::uint8_t nearestCode(std::uint32_t row) const { return rows_[std::size_t(row) * rowCodes_ + 1]; }

    /// The code of a gap, scene units.
    std::uint8_t code(double gap) const;

    /// How much of the blocks a yes-or-no query looks at, on average over the cells: 0 to 1.
    double looked() const { return looked_; }
    std::size_t bytes() const { return rows_.size() + grid_.size() * sizeof(GridCell); }

    /// For those who check it (verify). Rows from 1 on are cells.
    std::uint32_t rowCount() const { return static_cast<std::uint32_t>(rows_.size() / rowCodes_); }
    struct Box {
        DofValues centre{}, half{};
    };
    Box box(std::uint32_t row) const; ///< every q with rowAt(q) == row is in it
    std::uint8_t blockCode(std::uint32_t row, std::uint32_t block) const {
        return rows_[std::size_t(row) * rowCodes_ + headerCodes + block];
    }

private:
    struct Axis {
        double before = 0, perWidth = 0; ///< a part's width before the first part; parts per unit
        double beyond = 2;               ///< parts and one
        std::uint32_t parts = 1;         ///< over the whole range
        std::uint32_t halvings = 0;      ///< that make parts of a cell
        std::uint32_t stride = 0, partShift = 0, partMask = 0;
        double lower = 0, width = 0; ///< of the first part
    };
    /// A cell of the grid: one row, or where it does not tell whether tests touch, one row a part.
    struct GridCell {
        std::uint32_t first = 0, mask = 0; ///< mask 0: one row
    };
    class Maker;

    std::size_t dofs_ = 0;
    std::array<Axis, maxDofs> axes_{};
    std::vector<GridCell> grid_;
    double perUnit_ = 0; ///< codes per scene unit, up to nearCode; from there on for an ever larger range
    std::uint32_t rowCodes_ = codesPerGroup;
    /// Per row: reachedCode, the least code of a block, one code a block, farCode up to a whole group.
    std::vector<std::uint8_t> rows_;
    std::vector<std::uint32_t> cellOf_; ///< of each row; queries do not need it
    std::vector<std::uint32_t> order_;
    double looked_ = 1;
};

} // namespace tss
