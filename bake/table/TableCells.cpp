#include "bake/table/TableCells.h"

#include "bake/base/Infinity.h"
#include "bake/base/Order.h"
#include "bake/table/EvenParts.h"
#include "bake/table/GapRanges.h"

#include <bit>
#include <cmath>
#include <numeric>

namespace tss {

namespace {

/// At most so many cells in the grid, and so many codes for them before those that are far are left out.
constexpr std::size_t mostCells = 1024, mostCodes = std::size_t(1) << 18;
/// How often a cell is halved in which it is open whether tests touch, and how many bytes all may take.
constexpr std::uint32_t mostHalvings = 4;
constexpr std::size_t mostBytes = std::size_t(1) << 18;
/// Cells in which a test moves by less than this share of its contact distance are small enough.
constexpr double smallMove = 0.02;
/// Codes for the half of a cell's largest move.
constexpr double codesPerMove = 8;
/// Tests are put into blocks by where they can touch, told apart by so many parts of the limits.
constexpr std::uint32_t mostParts = 512;
/// How many tests are looked through for the next place in a block.
constexpr std::size_t orderWindow = 512;

using Parts = std::array<std::uint64_t, mostParts / 64>;

/// Codes of gaps above 0 that stand for steps of one length.
constexpr double evenCodes = TableCells::nearCode - TableCells::contactCode - 1;

/// Codes of a gap of `times` what even codes tell, 1 or more: eight for its first doubling, as for every one.
double farCodes(double times) {
    return 8 * std::log2(times);
}

} // namespace

/// Finds the codes of all tests in all cells, by halving the limits and leaving behind what is too far.
class TableCells::Maker {
public:
    Maker(TableCells& cells, const Motion& motion, std::span<const TablePair> pairs)
        : cells_(cells), motion_(motion), pairs_(pairs), dofs_(motion.dofCount()), ranges_(motion, pairs) {}

    /// Some DOF moves some test by more than rounding: else there is nothing to tell cells apart by.
    bool moves() const {
        for (std::size_t k = 0; k < dofs_; ++k)
            if (ranges_.weight(k) * (motion_.dofs[k].upper - motion_.dofs[k].lower) > ranges_.slack())
                return true;
        return false;
    }

    /// Cuts the limits into the grid and its cells into parts, always across the DOF that moves most within a
    /// piece.
    void cut() {
        std::array<double, maxDofs> move{};
        std::array<std::uint32_t, maxDofs> halvings{};
        for (std::size_t k = 0; k < dofs_; ++k)
            move[k] = ranges_.weight(k) * (motion_.dofs[k].upper - motion_.dofs[k].lower);
        const auto whole = [&] { return std::accumulate(move.begin(), move.begin() + dofs_, 0.0); };
        const auto halveWidest = [&] {
            if (!(whole() > smallMove * ranges_.middleReach())) return false;
            const auto k =
                static_cast<std::size_t>(std::max_element(move.begin(), move.end()) - move.begin());
            move[k] /= 2;
            ++halvings[k];
            order_.push_back(k);
            return true;
        };
        const std::size_t most = std::min(mostCells, mostCodes / pairs_.size());
        while (2 * cellCount_ <= most && halveWidest()) cellCount_ *= 2;
        cellHalvings_ = order_.size();
        const double cellMove = 0.5 * whole();
        const auto ofCells = halvings;
        while (partHalvings_ < mostHalvings && halveWidest()) ++partHalvings_;

        cells_.dofs_ = dofs_;
        std::uint32_t stride = 1, shift = 0;
        for (std::size_t k = 0; k < dofs_; ++k) {
            Axis& axis = cells_.axes_[k];
            axis.parts = 1u << halvings[k];
            axis.beyond = axis.parts + 1.0;
            axis.halvings = halvings[k] - ofCells[k];
            axis.partMask = (1u << axis.halvings) - 1;
            axis.partShift = shift;
            shift += axis.halvings;
            axis.stride = stride;
            stride <<= ofCells[k];
            const EvenParts even = evenParts(motion_.dofs[k], axis.parts);
            axis.lower = even.lower;
            axis.width = even.width;
            axis.perWidth = 1 / axis.width;
            axis.before = axis.lower - axis.width;
        }
        cells_.perUnit_ = codesPerMove / cellMove;
        nearGap_ = cellMove / codesPerMove * evenCodes;
    }

    /// Finds all rows: those of the cells of the grid, then those of the parts into which cells are cut where
    /// it is open whether a test touches.
    void findRows(std::uint32_t lanes) {
        std::vector<std::uint32_t> all = indicesOf(pairs_.size());
        Piece limits;
        for (std::size_t k = 0; k < dofs_; ++k) limits.size[k] = std::int32_t(cells_.axes_[k].parts);
        cells_.grid_.resize(cellCount_);
        found_.resize(1); // that of no cell
        cells_.cellOf_.assign(1, 0);
        halve(limits, all, 0);
        const std::size_t blocks = (pairs_.size() + lanes - 1) / lanes;
        rowCodes_ = (blocks + headerCodes + codesPerGroup - 1) / codesPerGroup * codesPerGroup;
        const std::size_t parts = std::size_t(1) << partHalvings_;
        if (parts > 1 && (found_.size() + open_.size() * parts) * rowCodes_ <= mostBytes)
            divideOpenCells(parts);
    }

    /// Orders the tests so that blocks of `lanes` hold tests that touch in the same parts of the limits: each
    /// block begins with the next test by its mean place, and takes those that add fewest parts to it.
    void orderTests(std::uint32_t lanes) {
        std::vector<std::uint32_t>& order = cells_.order_;
        order = indicesOf(pairs_.size());
        if (lanes == 1) return;
        const std::vector<Touching> touching = touchingParts();
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t x, std::uint32_t y) {
            return touching[x].meanRow < touching[y].meanRow;
        });
        for (std::size_t first = 0; first < order.size(); first += lanes) {
            Parts block = touching[order[first]].parts;
            const auto added = [&](std::uint32_t test) {
                int more = 0;
                for (std::size_t w = 0; w < block.size(); ++w)
                    more += std::popcount(touching[test].parts[w] & ~block[w]);
                return more * 1024 - touching[test].count; // of equals the one that touches in most
            };
            const std::size_t last = std::min(order.size(), first + lanes);
            for (std::size_t i = first + 1; i < last; ++i) {
                std::size_t best = i;
                int least = added(order[i]);
                for (std::size_t j = i + 1; j < std::min(order.size(), i + orderWindow); ++j)
                    if (const int more = added(order[j]); more < least) {
                        least = more;
                        best = j;
                    }
                // The others stay in their order.
                std::rotate(order.begin() + i, order.begin() + best, order.begin() + best + 1);
                for (std::size_t w = 0; w < block.size(); ++w) block[w] |= touching[order[i]].parts[w];
            }
        }
    }

    /// Writes the codes of all rows, block by block, and how much of the blocks queries look at.
    void writeRows(std::uint32_t lanes) {
        const std::size_t blocks = (pairs_.size() + lanes - 1) / lanes;
        std::vector<std::size_t> blockOf(pairs_.size());
        for (std::size_t i = 0; i < pairs_.size(); ++i) blockOf[cells_.order_[i]] = i / lanes;
        cells_.rowCodes_ = static_cast<std::uint32_t>(rowCodes_);
        cells_.rows_.assign(found_.size() * rowCodes_, farCode);
        std::fill_n(cells_.rows_.begin() + 1, blocks + 1, std::uint8_t(0));
        double looked = 0;
        for (std::size_t i = 1; i < found_.size(); ++i) {
            std::uint8_t* row = &cells_.rows_[i * rowCodes_];
            std::uint8_t* codes = row + headerCodes;
            row[0] = found_[i].reached;
            for (const Near& near : found_[i].near) {
                std::uint8_t& block = codes[blockOf[near.pair]];
                block = std::min(block, near.code);
            }
            row[1] = *std::min_element(codes, codes + blocks);
            if (row[0] <= contactCode) continue;
            const GridCell& cell = cells_.grid_[cells_.cellOf_[i]];
            if (cell.mask != 0 && i < cell.first) continue; // its parts stand for it
            looked += double(std::count_if(codes, codes + blocks,
                                           [](std::uint8_t c) { return c <= contactCode; })) /
                      (cell.mask + 1);
        }
        cells_.looked_ = looked / double(cellCount_ * blocks);
    }

private:
    /// A box of the limits: its first part and its size in parts, along each DOF.
    struct Piece {
        std::array<std::int32_t, maxDofs> first{}, size{};
    };
    /// A test that matters in a row.
    struct Near {
        std::uint32_t pair;
        std::uint8_t code;
    };
    struct Row {
        std::vector<Near> near;
        std::uint8_t reached = farCode;
    };

    /// Where a test touches.
    struct Touching {
        Parts parts{};       ///< of the limits
        int count = 0;       ///< of these
        double meanRow = -1; ///< of those in which it may touch; -1: none
    };
    std::vector<Touching> touchingParts() const {
        // Rows were found by halving, those of neighbours near one another.
        const std::size_t perPart = (found_.size() + mostParts - 1) / mostParts;
        std::vector<Touching> touching(pairs_.size());
        std::vector<double> sums(pairs_.size(), 0), rows(pairs_.size(), 0);
        for (std::size_t row = 1; row < found_.size(); ++row)
            for (const Near& near : found_[row].near) {
                if (near.code > contactCode) continue;
                const std::size_t part = row / perPart;
                touching[near.pair].parts[part / 64] |= std::uint64_t(1) << part % 64;
                sums[near.pair] += double(row);
                ++rows[near.pair];
            }
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            if (rows[p] > 0) touching[p].meanRow = sums[p] / rows[p];
            for (const std::uint64_t word : touching[p].parts) touching[p].count += std::popcount(word);
        }
        return touching;
    }

    /// How near the tests of a list come in a piece of the limits, in the list's order.
    struct Nearness {
        std::vector<double> lows;  ///< the least gap that each may have
        double reached = infinity; ///< everywhere some gap is at most this
        double matters = 0;        ///< a test farther away is neither near nor ever the nearest
    };
    Nearness nearness(const Piece& piece, const std::vector<std::uint32_t>& list) const {
        DofValues centre{}, half{}, way;
        way.fill(1);
        for (std::size_t k = 0; k < dofs_; ++k) {
            const Axis& axis = cells_.axes_[k];
            centre[k] = axis.lower + axis.width * (piece.first[k] + 0.5 * piece.size[k]);
            half[k] = 0.5 * axis.width * piece.size[k] * (1 + GapRanges::wider);
        }
        MotionFrame frame;
        evaluateFrame(motion_, centre.data(), way.data(), frame);
        Nearness found;
        found.lows.reserve(list.size());
        for (const std::uint32_t pair : list) {
            const GapRanges::Range range = ranges_.range(pair, frame, half);
            found.lows.push_back(range.low);
            found.reached = std::min(found.reached, range.high);
        }
        found.matters = std::max(found.reached, nearGap_);
        return found;
    }

    /// The cell of the grid that the piece begins in, and the place of its first part there.
    std::uint32_t cellOf(const Piece& piece) const {
        std::uint32_t cell = 0;
        for (std::size_t k = 0; k < dofs_; ++k)
            cell += (static_cast<std::uint32_t>(piece.first[k]) >> cells_.axes_[k].halvings) *
                    cells_.axes_[k].stride;
        return cell;
    }
    std::uint32_t partOf(const Piece& piece) const {
        std::uint32_t part = 0;
        for (std::size_t k = 0; k < dofs_; ++k)
            part += (static_cast<std::uint32_t>(piece.first[k]) & cells_.axes_[k].partMask)
                    << cells_.axes_[k].partShift;
        return part;
    }

    /// Halves a piece of the limits down to the cells of the grid, or with a `firstRow` a cell down to its
    /// parts, of which the first has that row.
    void halve(const Piece& piece, const std::vector<std::uint32_t>& list, std::size_t depth,
               std::uint32_t firstRow = 0) {
        const Nearness found = nearness(piece, list);
        if (depth == (firstRow != 0 ? order_.size() : cellHalvings_))
            return addRow(piece, list, found, firstRow);
        std::vector<std::uint32_t> near;
        for (std::size_t i = 0; i < list.size(); ++i)
            if (!(found.lows[i] > found.matters)) near.push_back(list[i]);
        const std::size_t k = order_[depth];
        Piece lower = piece, upper = piece;
        lower.size[k] = upper.size[k] = piece.size[k] / 2;
        upper.first[k] += lower.size[k];
        halve(lower, near, depth + 1, firstRow);
        halve(upper, near, depth + 1, firstRow);
    }

    /// The row of a cell, or of a part of one.
    void addRow(const Piece& piece, const std::vector<std::uint32_t>& list, const Nearness& found,
                std::uint32_t firstRow) {
        Row row;
        row.reached = cells_.code(found.reached);
        for (std::size_t i = 0; i < list.size(); ++i)
            if (!(found.lows[i] > found.matters)) row.near.push_back({list[i], cells_.code(found.lows[i])});
        if (firstRow != 0) {
            found_[firstRow + partOf(piece)] = std::move(row);
            return;
        }
        const bool touches =
            std::ranges::any_of(row.near, [](const Near& near) { return near.code <= contactCode; });
        if (touches && row.reached > contactCode) open_.push_back(piece);
        const std::uint32_t cell = cellOf(piece);
        cells_.grid_[cell].first = static_cast<std::uint32_t>(found_.size());
        cells_.cellOf_.push_back(cell);
        found_.push_back(std::move(row));
    }

    /// Cuts the open cells into `parts` rows each, behind those of the cells.
    void divideOpenCells(std::size_t parts) {
        for (const Piece& piece : open_) {
            const std::uint32_t cell = cellOf(piece);
            GridCell& entry = cells_.grid_[cell];
            std::vector<std::uint32_t> list;
            for (const Near& near : found_[entry.first].near) list.push_back(near.pair);
            entry.first = static_cast<std::uint32_t>(found_.size());
            entry.mask = static_cast<std::uint32_t>(parts - 1);
            found_.resize(found_.size() + parts);
            cells_.cellOf_.resize(found_.size(), cell);
            halve(piece, list, cellHalvings_, entry.first);
        }
    }

    TableCells& cells_;
    const Motion& motion_;
    std::span<const TablePair> pairs_;
    std::size_t dofs_;
    GapRanges ranges_;
    double nearGap_ = 0;             ///< gaps up to it have codes up to nearCode
    std::vector<std::size_t> order_; ///< which DOF each halving cuts
    std::size_t cellCount_ = 1, cellHalvings_ = 0;
    std::uint32_t partHalvings_ = 0;
    std::size_t rowCodes_ = codesPerGroup;
    std::vector<Row> found_;  ///< one per row
    std::vector<Piece> open_; ///< cells in which some tests may touch and none does everywhere
};

TableCells::TableCells(const Motion& motion, std::span<const TablePair> pairs, std::uint32_t lanes) {
    Maker maker(*this, motion, pairs);
    if (!maker.moves()) return;
    maker.cut();
    maker.findRows(lanes);
    maker.orderTests(lanes);
    maker.writeRows(lanes);
}

std::uint8_t TableCells::code(double gap) const {
    const double x = gap * perUnit_;
    if (!(gap > 0))
        return static_cast<std::uint8_t>(std::max(0.0, contactCode + std::ceil(std::max(x, -255.0))));
    const double code =
        contactCode + 1 +
        (x < evenCodes ? std::floor(x) : evenCodes + std::floor(std::min(farCodes(x / evenCodes), 255.0)));
    return static_cast<std::uint8_t>(std::min(code, double(farCode)));
}

TableCells::Box TableCells::box(std::uint32_t row) const {
    const std::uint32_t cell = cellOf_[row];
    const GridCell& entry = grid_[cell];
    const bool whole = entry.mask == 0 || row < entry.first; // of a cell that was divided, before it was
    Box found;
    for (std::size_t k = 0; k < dofs_; ++k) {
        const Axis& axis = axes_[k];
        const std::uint32_t perCell = 1u << axis.halvings;
        const std::uint32_t cells = axis.parts / perCell;
        const std::uint32_t first = cell / axis.stride % cells * perCell;
        const std::uint32_t part = whole ? 0 : (row - entry.first) >> axis.partShift & axis.partMask;
        const double size = whole ? perCell : 1;
        found.centre[k] = axis.lower + axis.width * (first + part + 0.5 * size);
        found.half[k] = 0.5 * axis.width * size;
    }
    return found;
}

} // namespace tss
