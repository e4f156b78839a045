#include "bake/base/Order.h"
#include "bake/verify/KernelProofs.h"

#include "bake/verify/GapBox.h"

#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <optional>

namespace tss::verify {

namespace {

/// How often a cell or a piece is halved where bounds over the whole of it do not suffice, next to where
/// contact begins down to what doubles tell apart; and how many parts of one are looked at.
constexpr int mostDepth = 60;
constexpr int mostLooks = 20000;
/// A cell is taken so much wider than it is: for what rounding does when it is looked up.
constexpr double wider = 1e-7;

using List = std::vector<std::uint32_t>;

class VerdictChecker {
public:
    VerdictChecker(const Table& table, const PreparedTable& prepared)
        : grid_(prepared.verdicts()), dofs_(table.motion.dofCount()), band_(prepared.signBand()),
          gaps_(table) {
        all_ = indicesOf(gaps_.testCount());
    }

    std::string refute() {
        Block limits;
        for (std::size_t k = 0; k < dofs_; ++k) limits.size[k] = grid_.cellCount(k) * grid_.partsPerCell(k);
        std::string reason = refuteBlock(limits, all_);
        const auto& pieces = grid_.pieces();
        for (std::size_t i = 0; i + 1 < pieces.size() && reason.empty(); ++i) {
            if (pieces[i].verdict == Verdict::Ask) continue;
            const Box box{{pieces[i].from}, {pieces[i + 1].from}};
            if (!holds(box, pieces[i].verdict, 0, all_, 0))
                reason = fmt::format(
                    "with its DOF from {} to {} (rad or scene units) its verdict is not what the tests say",
                    box.lower[0], box.upper[0]);
        }
        if (reason.empty() && !pieces.empty() && pieces.back().verdict != Verdict::Ask)
            reason = "its last piece has no end";
        return reason;
    }

private:
    using Place = VerdictGrid::Place;

    /// Some whole cells, or some parts of one.
    struct Block {
        Place first{}, size{1, 1, 1};
    };
    /// How many cells of the block lie along DOF k; less than 1 within a cell.
    double cellsAlong(const Block& block, std::size_t k) const {
        return double(block.size[k]) / grid_.partsPerCell(k);
    }
    bool withinCell(const Block& block) const {
        for (std::size_t k = 0; k < dofs_; ++k)
            if (cellsAlong(block, k) > 1) return false;
        return true;
    }

    Box boxOf(const Block& block) const {
        const VerdictGrid::Box values = grid_.box(block.first, block.size);
        Box box;
        for (std::size_t k = 0; k < dofs_; ++k) {
            const double hair = wider * (values.upper[k] - values.lower[k]);
            box.lower.push_back(values.lower[k] - hair);
            box.upper.push_back(values.upper[k] + hair);
        }
        return box;
    }

    /// What all of the block have in common: Ask where they say nothing, and nothing in common where they
    /// differ.
    std::optional<Verdict> common(const Block& block, double& clearance) const {
        const bool cell = withinCell(block);
        if (cell && !grid_.divided(block.first)) {
            clearance = grid_.clearanceOf(block.first);
            return grid_.verdictOf(block.first);
        }
        Place step{1, 1, 1};
        for (std::size_t k = 0; k < dofs_ && !cell; ++k) step[k] = grid_.partsPerCell(k);
        std::optional<Verdict> all;
        Place at{};
        clearance = 0;
        for (at[2] = 0; at[2] < block.size[2]; at[2] += step[2])
            for (at[1] = 0; at[1] < block.size[1]; at[1] += step[1])
                for (at[0] = 0; at[0] < block.size[0]; at[0] += step[0]) {
                    const Place part{block.first[0] + at[0], block.first[1] + at[1], block.first[2] + at[2]};
                    if (!cell && grid_.divided(part)) return std::nullopt;
                    const Verdict verdict = grid_.verdictOf(part);
                    if (all && *all != verdict) return std::nullopt;
                    all = verdict;
                    clearance = std::max(clearance, grid_.clearanceOf(part));
                }
        return all;
    }

    /// Much at once where one bound shows what all of it says.
    std::string refuteBlock(const Block& block, const List& list) {
        double clearance = 0;
        const std::optional<Verdict> verdict = common(block, clearance);
        if (verdict == Verdict::Ask) return {};
        const Box box = boxOf(block);
        const bool single =
            block.size == Place{1, 1, 1} || (withinCell(block) && !grid_.divided(block.first));
        if (verdict && holds(box, *verdict, clearance, list, single ? 0 : mostDepth)) return {};
        if (single)
            return fmt::format("the verdict of the cell from part {}, {}, {} is not what the tests say",
                               block.first[0], block.first[1], block.first[2]);
        const List near = nearest(list, gaps_.bound(box, list));
        // Down to whole cells first.
        const bool cell = withinCell(block);
        const auto along = [&](std::size_t k) { return cell ? block.size[k] : cellsAlong(block, k); };
        std::size_t k = 0;
        for (std::size_t l = 1; l < dofs_; ++l)
            if (along(l) > along(k)) k = l;
        Block lower = block, upper = block;
        lower.size[k] = block.size[k] / 2;
        upper.size[k] = block.size[k] - lower.size[k];
        upper.first[k] += lower.size[k];
        std::string reason = refuteBlock(lower, near);
        return reason.empty() ? refuteBlock(upper, near) : reason;
    }

    /// The tests that may have the smallest gap somewhere in the box that was bounded last: `high` at most.
    List nearest(const List& list, double high) const {
        List near;
        for (const std::uint32_t p : list)
            if (gaps_.low(p) <= high) near.push_back(p);
        return near;
    }

    bool holds(const Box& box, Verdict verdict, double clearance, const List& list, int halvings) {
        if (halvings == 0) looks_ = 0;
        const double high = gaps_.bound(box, list);
        double low = std::numeric_limits<double>::infinity();
        for (const std::uint32_t p : list) low = std::min(low, gaps_.low(p));
        if (verdict == Verdict::Touch ? high <= band_ : low > 0 && low >= clearance) return true;
        if (halvings >= mostDepth || ++looks_ > mostLooks) return false;
        const List near = nearest(list, high);
        // Across each DOF in turn: cells are about as wide in all of them.
        const std::size_t k = std::size_t(halvings) % dofs_;
        const auto [lower, upper] = box.halves(k, box.middle(k));
        return holds(lower, verdict, clearance, near, halvings + 1) &&
               holds(upper, verdict, clearance, near, halvings + 1);
    }

    const VerdictGrid& grid_;
    std::size_t dofs_;
    double band_;
    GapBox gaps_;
    List all_;
    int looks_ = 0; ///< at parts of the present cell or piece
};

} // namespace

std::string refuteVerdicts(const Table& table, const PreparedTable& prepared) {
    return prepared.verdicts().empty() ? std::string() : VerdictChecker(table, prepared).refute();
}

} // namespace tss::verify
