#include "bake/verify/VerdictProof.h"

#include "bake/verify/GapBox.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <optional>

namespace tss::verify {

namespace {

/// How often a cell or a piece is halved where bounds over the whole of it do not suffice, next to where contact
/// begins down to what doubles tell apart; and how many parts of one are looked at.
constexpr int mostHalvings = 60;
constexpr int mostLooks = 20000;
/// A cell is taken so much wider than it is: for what rounding does when it is looked up.
constexpr double wider = 1e-7;

using List = std::vector<std::uint32_t>;

class Checker {
public:
    Checker(const Table& table, const PreparedTable& prepared)
        : grid_(prepared.verdicts()), dofs_(table.motion.dofCount()), band_(prepared.signBand()),
          gaps_(table) {
        all_.resize(gaps_.testCount());
        std::iota(all_.begin(), all_.end(), 0u);
    }

    std::string refute() {
        Cells cells;
        for (std::size_t k = 0; k < dofs_; ++k) cells.size[k] = grid_.cellCount(k);
        std::string reason = refuteCells(cells, all_);
        const auto& pieces = grid_.pieces();
        for (std::size_t i = 0; i + 1 < pieces.size() && reason.empty(); ++i) {
            if (pieces[i].verdict == Verdict::Ask) continue;
            const Box box{{pieces[i].from}, {pieces[i + 1].from}};
            if (!holds(box, pieces[i].verdict, 0, all_, 0))
                reason = fmt::format("from {} to {} its verdict is not what the tests say", box.lower[0],
                                     box.upper[0]);
        }
        if (reason.empty() && !pieces.empty() && pieces.back().verdict != Verdict::Ask)
            reason = "its last piece has no end";
        return reason;
    }

private:
    struct Cells {
        std::array<std::uint32_t, 3> first{}, size{1, 1, 1};
        std::uint32_t count() const { return size[0] * size[1] * size[2]; }
    };

    Box boxOf(const Cells& cells) const {
        std::array<std::uint32_t, 3> last = cells.first;
        for (std::size_t k = 0; k < dofs_; ++k) last[k] += cells.size[k] - 1;
        const VerdictGrid::Box from = grid_.box(cells.first), to = grid_.box(last);
        Box box;
        for (std::size_t k = 0; k < dofs_; ++k) {
            const double hair = wider * (from.upper[k] - from.lower[k]);
            box.lower.push_back(from.lower[k] - hair);
            box.upper.push_back(to.upper[k] + hair);
        }
        return box;
    }

    /// What all the cells have in common: Ask where they say nothing, and nothing in common where they
    /// differ.
    std::optional<Verdict> common(const Cells& cells, double& clearance) const {
        std::optional<Verdict> all;
        std::array<std::uint32_t, 3> at{};
        clearance = 0;
        for (at[2] = 0; at[2] < cells.size[2]; ++at[2])
            for (at[1] = 0; at[1] < cells.size[1]; ++at[1])
                for (at[0] = 0; at[0] < cells.size[0]; ++at[0]) {
                    const std::array<std::uint32_t, 3> cell{cells.first[0] + at[0], cells.first[1] + at[1],
                                                            cells.first[2] + at[2]};
                    const Verdict verdict = grid_.verdictOf(cell);
                    if (all && *all != verdict) return std::nullopt;
                    all = verdict;
                    clearance = std::max(clearance, grid_.clearanceOf(cell));
                }
        return all;
    }

    /// Many cells at once where one bound shows what all of them say.
    std::string refuteCells(const Cells& cells, const List& list) {
        double clearance = 0;
        const std::optional<Verdict> verdict = common(cells, clearance);
        if (verdict == Verdict::Ask) return {};
        const Box box = boxOf(cells);
        const bool single = cells.count() == 1;
        if (verdict && holds(box, *verdict, clearance, list, single ? 0 : mostHalvings)) return {};
        if (single)
            return fmt::format("the verdict of cell {}, {}, {} is not what the tests say", cells.first[0],
                               cells.first[1], cells.first[2]);
        const List near = nearest(box, list);
        std::size_t k = 0;
        for (std::size_t l = 1; l < dofs_; ++l)
            if (cells.size[l] > cells.size[k]) k = l;
        Cells lower = cells, upper = cells;
        lower.size[k] = cells.size[k] / 2;
        upper.size[k] = cells.size[k] - lower.size[k];
        upper.first[k] += lower.size[k];
        std::string reason = refuteCells(lower, near);
        return reason.empty() ? refuteCells(upper, near) : reason;
    }

    /// The tests that may have the smallest gap somewhere in the box.
    List nearest(const Box& box, const List& list) {
        const double high = gaps_.bound(box, list);
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
        if (halvings >= mostHalvings || ++looks_ > mostLooks) return false;
        List near;
        for (const std::uint32_t p : list)
            if (gaps_.low(p) <= high) near.push_back(p);
        // Across each DOF in turn: cells are about as wide in all of them.
        const std::size_t k = std::size_t(halvings) % dofs_;
        Box lower = box, upper = box;
        lower.upper[k] = upper.lower[k] = box.middle(k);
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
    return prepared.verdicts().empty() ? std::string() : Checker(table, prepared).refute();
}

} // namespace tss::verify
