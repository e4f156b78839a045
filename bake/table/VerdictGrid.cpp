#include "bake/table/VerdictGrid.h"

#include "bake/table/GapRanges.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace tss {

namespace {

/// Cells for one, two and three DOFs, about: what stays in the first level of a processor's cache, and in the
/// second for three.
constexpr std::uint32_t mostCells[] = {512, 1u << 15, 1u << 16};
/// Tables of more tests than this would take long to load.
constexpr std::size_t mostTests = 1 << 16;
/// A clearance is known well enough where the cell's own motion is this share of it.
constexpr double enoughOf = 0.25;
/// What clearances are told in, as a share of the most that gaps change over one cell.
constexpr double unitOf = 0.25;
/// How often the values of one DOF are halved to find where contact begins.
constexpr int mostHalvings = 48;
/// More pieces than this are not searched through, and no more parts of a cell looked at for them: contact
/// that only grazes has its beginning nowhere in particular.
constexpr std::size_t mostPieces = 32;
constexpr int mostLooks = 400;

} // namespace

/// Finds the codes by halving the limits, each half with those tests only that may be the nearest in it.
class VerdictGrid::Maker {
public:
    Maker(VerdictGrid& grid, const Motion& motion, std::span<const TablePair> pairs, double band)
        : grid_(grid), motion_(motion), ranges_(motion, pairs), band_(band), all_(pairs.size()) {
        std::iota(all_.begin(), all_.end(), 0u);
    }

    bool moves() const { return ranges_.wholeMove() > ranges_.slack(); }

    void make() {
        cut();
        Piece3 limits;
        for (std::size_t k = 0; k < grid_.dofs_; ++k) limits.size[k] = grid_.axes_[k].cells;
        halve(limits, all_, 0);
        if (grid_.dofs_ == 1) findPieces();
        const double cells =
            std::accumulate(grid_.axes_.begin(), grid_.axes_.begin() + std::ptrdiff_t(grid_.dofs_), 1.0,
                            [](double n, const Axis& axis) { return n * axis.cells; });
        grid_.asked_ = grid_.pieces_.empty() ? asked_ / cells : 0;
    }

private:
    struct Piece3 {
        std::array<std::uint32_t, 3> first{}, size{1, 1, 1};
    };

    /// Always across the DOF that moves most within a cell.
    void cut() {
        const std::size_t dofs = motion_.dofCount();
        std::array<double, 3> move{};
        for (std::size_t k = 0; k < dofs; ++k)
            move[k] = ranges_.weight(k) * (motion_.dofs[k].upper - motion_.dofs[k].lower);
        std::array<std::uint32_t, 3> cells{1, 1, 1};
        for (std::uint32_t count = 1; count < mostCells[dofs - 1]; count *= 2) {
            const auto k =
                static_cast<std::size_t>(std::max_element(move.begin(), move.end()) - move.begin());
            move[k] /= 2;
            cells[k] *= 2;
            order_.push_back(k);
        }
        std::uint32_t stride = 1;
        grid_.dofs_ = dofs;
        for (std::size_t k = 0; k < dofs; ++k) {
            const Dof& dof = motion_.dofs[k];
            Axis& axis = grid_.axes_[k];
            // A little over the limits, so that what rounding puts beyond them has a cell, and so that a DOF
            // without a range has a width.
            const double range = dof.upper - dof.lower;
            const double size = std::max(std::abs(dof.lower), std::abs(dof.upper));
            const double over = 1e-9 * range + 4 * std::numeric_limits<double>::epsilon() * size + 1e-290;
            axis.cells = cells[k];
            axis.beyond = cells[k] + 1.0;
            axis.lower = dof.lower - over;
            axis.width = (range + 2 * over) / cells[k];
            axis.perWidth = 1 / axis.width;
            axis.before = axis.lower - axis.width;
            axis.stride = stride;
            stride *= cells[k] + 2;
        }
        grid_.codes_.assign(stride, askCode);
        grid_.unit_ = unitOf * std::accumulate(move.begin(), move.end(), 0.0);
    }

    /// The least and the most that the smallest gap can be over a box; `near` receives the tests that may
    /// have it.
    GapRanges::Range smallest(const DofValues& centre, const DofValues& half,
                              std::span<const std::uint32_t> list, std::vector<std::uint32_t>& near) const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        DofValues way;
        way.fill(1);
        MotionFrame frame;
        evaluateFrame(motion_, centre.data(), way.data(), frame);
        std::vector<double> lows(list.size());
        GapRanges::Range least{infinity, infinity};
        for (std::size_t i = 0; i < list.size(); ++i) {
            const GapRanges::Range found = ranges_.range(list[i], frame, half);
            lows[i] = found.low;
            least.low = std::min(least.low, found.low);
            least.high = std::min(least.high, found.high);
        }
        for (std::size_t i = 0; i < list.size(); ++i)
            if (lows[i] <= least.high) near.push_back(list[i]);
        return least;
    }

    void halve(const Piece3& piece, std::span<const std::uint32_t> list, std::size_t depth) {
        DofValues centre{}, half{};
        double move = 0;
        for (std::size_t k = 0; k < grid_.dofs_; ++k) {
            const Axis& axis = grid_.axes_[k];
            centre[k] = axis.lower + axis.width * (piece.first[k] + 0.5 * piece.size[k]);
            half[k] = 0.5 * axis.width * piece.size[k] * (1 + GapRanges::wider);
            move += ranges_.weight(k) * half[k];
        }
        std::vector<std::uint32_t> near;
        const GapRanges::Range gap = smallest(centre, half, list, near);
        constexpr double mostCode = 255;
        const double told =
            gap.low > 0 ? std::min(freeCode + std::floor(gap.low / grid_.unit_), mostCode) : 0;
        const bool enough = gap.low > 0 && (told == mostCode || move <= enoughOf * gap.low);
        if (gap.high <= 0) return write(piece, touchCode);
        if (enough || depth == order_.size()) return write(piece, static_cast<std::uint8_t>(told));
        const std::size_t k = order_[depth];
        Piece3 lower = piece, upper = piece;
        lower.size[k] = upper.size[k] = piece.size[k] / 2;
        upper.first[k] += lower.size[k];
        halve(lower, near, depth + 1);
        halve(upper, near, depth + 1);
    }

    void write(const Piece3& piece, std::uint8_t code) {
        if (code == askCode) asked_ += 1;
        std::array<std::uint32_t, 3> at{};
        for (at[2] = 0; at[2] < piece.size[2]; ++at[2])
            for (at[1] = 0; at[1] < piece.size[1]; ++at[1])
                for (at[0] = 0; at[0] < piece.size[0]; ++at[0])
                    grid_.codes_[grid_.cellOf(
                        {piece.first[0] + at[0], piece.first[1] + at[1], piece.first[2] + at[2]})] = code;
    }

    /// Where contact begins and ends within the cells that say Ask.
    void findPieces() {
        std::vector<Piece> pieces;
        const Axis& axis = grid_.axes_[0];
        for (std::uint32_t i = 0; i < axis.cells; ++i) {
            if (grid_.codes_[grid_.cellOf({i, 0, 0})] != askCode) continue;
            const double from = axis.lower + axis.width * i, hair = axis.width * GapRanges::wider;
            add(pieces, from - hair, Verdict::Ask);
            looks_ = 0;
            bracket(pieces, from - hair, from + axis.width + hair, all_, 0);
            add(pieces, from + axis.width + hair, Verdict::Ask);
            if (pieces.size() > mostPieces) return;
        }
        if (!pieces.empty()) grid_.pieces_ = std::move(pieces);
    }

    static void add(std::vector<Piece>& pieces, double from, Verdict verdict) {
        if (!pieces.empty() && pieces.back().from >= from) pieces.pop_back();
        if (pieces.empty() || pieces.back().verdict != verdict) pieces.push_back({from, verdict});
    }

    void bracket(std::vector<Piece>& pieces, double lower, double upper, std::span<const std::uint32_t> list,
                 int depth) {
        DofValues centre{}, half{};
        centre[0] = lower + 0.5 * (upper - lower);
        // Outward by what the middle and the half may round.
        half[0] = 0.5 * (upper - lower) * (1 + GapRanges::wider) +
                  4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(lower), std::abs(upper));
        std::vector<std::uint32_t> near;
        const GapRanges::Range gap = smallest(centre, half, list, near);
        if (gap.low > 0) return add(pieces, lower, Verdict::Free);
        if (gap.high <= band_) return add(pieces, lower, Verdict::Touch);
        if (depth == mostHalvings || !(centre[0] > lower && centre[0] < upper) || ++looks_ > mostLooks)
            return add(pieces, lower, Verdict::Ask);
        bracket(pieces, lower, centre[0], near, depth + 1);
        bracket(pieces, centre[0], upper, near, depth + 1);
    }

    VerdictGrid& grid_;
    const Motion& motion_;
    GapRanges ranges_;
    double band_;
    std::vector<std::uint32_t> all_;
    std::vector<std::size_t> order_; ///< which DOF each halving cuts
    double asked_ = 0;               ///< cells that say Ask
    int looks_ = 0;                  ///< for pieces of one cell
};

VerdictGrid::VerdictGrid(const Motion& motion, std::span<const TablePair> pairs, double band) {
    if (motion.dofCount() < 1 || motion.dofCount() > 3 || pairs.empty() || pairs.size() > mostTests) return;
    Maker maker(*this, motion, pairs, band);
    if (maker.moves()) maker.make();
}

std::uint32_t VerdictGrid::cellOf(const std::array<std::uint32_t, 3>& cell) const {
    std::uint32_t at = 0;
    for (std::size_t k = 0; k < dofs_; ++k) at += (cell[k] + 1) * axes_[k].stride;
    return at;
}

Verdict VerdictGrid::pieceAt(double q) const {
    Verdict verdict = Verdict::Ask;
    for (const Piece& piece : pieces_) {
        if (!(piece.from <= q)) break;
        verdict = piece.verdict;
    }
    return verdict;
}

VerdictGrid::Box VerdictGrid::box(const std::array<std::uint32_t, 3>& cell) const {
    Box found;
    for (std::size_t k = 0; k < dofs_; ++k) {
        found.lower[k] = axes_[k].lower + axes_[k].width * cell[k];
        found.upper[k] = axes_[k].lower + axes_[k].width * (cell[k] + 1.0);
    }
    return found;
}

Verdict VerdictGrid::verdictOf(const std::array<std::uint32_t, 3>& cell) const {
    const std::uint8_t code = codes_[cellOf(cell)];
    return code == askCode ? Verdict::Ask : code == touchCode ? Verdict::Touch : Verdict::Free;
}

double VerdictGrid::clearanceOf(const std::array<std::uint32_t, 3>& cell) const {
    const std::uint8_t code = codes_[cellOf(cell)];
    return code < freeCode ? 0 : (code - freeCode) * unit_;
}

} // namespace tss
