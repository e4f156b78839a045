#include "bake/base/Order.h"
#include "bake/verify/KernelProofs.h"

#include "bake/verify/GapBox.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>

namespace tss::verify {

namespace {

/// How often a cell is halved where bounds over the whole of it do not suffice.
constexpr int mostHalvings = 12;

class CellChecker {
public:
    CellChecker(const Table& table, const PreparedTable& prepared)
        : table_(table), cells_(prepared.kernels().cells()), gaps_(table), block_(gaps_.testCount()),
          all_(indicesOf(gaps_.testCount())) {
        for (std::size_t i = 0; i < block_.size(); ++i)
            block_[cells_.order()[i]] = static_cast<std::uint32_t>(i / prepared.kernels().lanes());
    }

    std::string refute() {
        for (std::uint32_t row = 1; row < cells_.rowCount(); ++row) {
            const TableCells::Box cell = cells_.box(row);
            Box box;
            for (std::size_t k = 0; k < table_.motion.dofCount(); ++k) {
                const double half = cell.half[k] * (1 + 1e-7); // where rounding finds another cell
                box.lower.push_back(cell.centre[k] - half);
                box.upper.push_back(cell.centre[k] + half);
            }
            if (std::string reason = refute(row, box, 0); !reason.empty()) return reason;
        }
        return {};
    }

private:
    /// What the codes of the row claim and the bounds over the box do not give; empty: nothing.
    std::string unproven(std::uint32_t row, double high) const {
        const std::uint8_t reached = cells_.reachedCode(row);
        if (reached <= TableCells::contactCode && !(high <= 0))
            return fmt::format("cell {} says that every pose of it touches", row);
        if (reached < TableCells::farCode && cells_.code(high) > reached)
            return fmt::format("cell {} says that the smallest gap is smaller than it may be", row);
        std::uint8_t least = TableCells::farCode;
        for (std::size_t p = 0; p < block_.size(); ++p) {
            const std::uint8_t claimed = cells_.blockCode(row, block_[p]);
            least = std::min(least, claimed);
            if (cells_.code(gaps_.low(p)) < std::min(claimed, TableCells::nearCode))
                return fmt::format("cell {} leaves out test {}, which may come nearer", row, p);
            if (claimed > reached && !(gaps_.low(p) >= high))
                return fmt::format("cell {} leaves out test {}, which may be the nearest", row, p);
        }
        if (cells_.noneTouches(row) && least <= TableCells::contactCode)
            return fmt::format("cell {} says that no pose of it touches", row);
        return {};
    }

    std::string refute(std::uint32_t row, const Box& box, int halvings) {
        const std::string reason = unproven(row, gaps_.bound(box, all_));
        if (reason.empty() || halvings == mostHalvings) return reason;
        // Across each DOF in turn: cells are about as wide in all of them.
        const std::size_t dofs = box.lower.size(), k = std::size_t(halvings) % dofs;
        const auto [lower, upper] = box.halves(k, box.middle(k));
        const std::string first = refute(row, lower, halvings + 1);
        return first.empty() ? refute(row, upper, halvings + 1) : first;
    }

    const Table& table_;
    const TableCells& cells_;
    GapBox gaps_;
    std::vector<std::uint32_t> block_; ///< of each test
    std::vector<std::uint32_t> all_;   ///< the tests
};

} // namespace

StoredTests::StoredTests(const PreparedTable& prepared) : prepared_(prepared) {
    const TableKernels& kernels = prepared.kernels();
    const bool clusters = !kernels.clusters().empty();
    const auto& order = clusters ? kernels.clusters().order() : kernels.cells().order();
    const std::size_t count = prepared.testCount();
    constexpr auto none = std::numeric_limits<std::uint32_t>::max();
    place_.assign(count, none);
    if (!order.empty() && order.size() != count) return;
    for (std::uint32_t place = 0; place < count; ++place) {
        const std::uint32_t test = order.empty() ? place : order[place];
        if (test >= count || place_[test] != none) return;
        place_[test] = place;
    }
    for (std::uint32_t test = 0; test < count; ++test) {
        const StoredRow inBlocks(prepared, kernels.blocks(), place_[test], kernels.lanes());
        if (inBlocks.number() != test) return;
        if (!clusters && !inBlocks.sameAs((*this)[test])) return;
    }
    eachOnce_ = true;
}

StoredRow StoredTests::operator[](std::size_t test) const {
    const TableKernels& kernels = prepared_.kernels();
    if (kernels.clusters().empty()) return {prepared_, kernels.rows(), test};
    return {prepared_, kernels.blocks(), place_[test], kernels.lanes()};
}

bool blocksAreRows(const PreparedTable& prepared, const KernelData& blocks, const KernelData& rows,
                   std::size_t count) {
    for (std::size_t row = 0; row < count; ++row)
        if (!StoredRow(prepared, blocks, row, prepared.kernels().lanes())
                 .sameAs(StoredRow(prepared, rows, row)))
            return false;
    return true;
}

bool rowsAreTests(const PreparedTable& prepared, const KernelData& rows,
                  std::span<const std::uint32_t> tests) {
    const std::size_t number = prepared.precision() == KernelPrecision::Float ? 4 : 8;
    const auto* begin = static_cast<const std::byte*>(rows.blocks);
    if (begin + tests.size() * directColumns * number != rows.end) return false;
    const StoredTests all(prepared);
    if (!all.eachOnce()) return false;
    for (std::size_t i = 0; i < tests.size(); ++i)
        if (tests[i] >= prepared.testCount() || !StoredRow(prepared, rows, i).sameAs(all[tests[i]]))
            return false;
    return true;
}

std::string refuteCells(const Table& table, const PreparedTable& prepared) {
    if (prepared.kernels().cells().empty()) return {};
    return CellChecker(table, prepared).refute();
}

} // namespace tss::verify
