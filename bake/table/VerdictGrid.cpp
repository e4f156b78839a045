#include "bake/table/VerdictGrid.h"

#include "bake/base/Infinity.h"
#include "bake/base/Order.h"
#include "bake/table/EvenParts.h"
#include "bake/table/GapRanges.h"

#include <algorithm>
#include <cmath>

namespace tss {

namespace {

/// Cells for one, two and three DOFs: half of what stays in the first level of a processor's cache, or all of
/// it. So many open ones are divided, 64 bytes each, at most: 64 and 256 kB.
constexpr std::uint32_t mostGridCells[] = {512, 1u << 14, 1u << 15};
constexpr std::size_t mostDivided[] = {0, 1 << 10, 1 << 12};
/// Looks at a test over a box, all together: some tenths of a second when a table is loaded, and as many for
/// the pieces of one DOF. Where they end, cells stay open.
constexpr std::uint64_t mostEffort = 20'000'000;
/// A clearance is known well enough where the cell's own motion is this share of it.
constexpr double enoughOf = 0.25;
/// What clearances are told in, as a share of the most that gaps change over one cell.
constexpr double unitOf = 0.25;
/// How often the values of one DOF are halved to find where contact begins.
constexpr int mostDepth = 48;
/// More pieces than this are not searched through, and no more parts of a cell looked at for them: contact
/// that only grazes has its beginning nowhere in particular.
constexpr std::size_t mostPieces = 32;
constexpr int mostLooks = 400;

} // namespace

/// Finds the codes by halving the limits, each half with those tests only that may be the nearest in it.
class VerdictGrid::Maker {
public:
    Maker(VerdictGrid& grid, const Motion& motion, std::span<const TablePair> pairs, double band)
        : grid_(grid), motion_(motion), ranges_(motion, pairs), band_(band), all_(indicesOf(pairs.size())) {}

    bool moves() const { return ranges_.wholeMove() > ranges_.slack(); }

    void make() {
        cut();
        Block limits;
        double parts = 1;
        for (std::size_t k = 0; k < grid_.dofs_; ++k) {
            limits.size[k] = grid_.axes_[k].cells << grid_.axes_[k].halvings;
            parts *= limits.size[k];
        }
        halve(limits, all_, 0, mostEffort);
        if (grid_.dofs_ == 1) findPieces();
        grid_.asked_ = grid_.pieces_.empty() ? asked_ / parts : 0;
    }

private:
    /// Some parts of cells.
    struct Block {
        Place first{}, size{1, 1, 1};
    };

    /// Cuts the limits into cells and these into parts, always across the DOF that moves most within one.
    void cut() {
        const std::size_t dofs = motion_.dofCount();
        std::array<double, 3> move{};
        for (std::size_t k = 0; k < dofs; ++k)
            move[k] = ranges_.weight(k) * (motion_.dofs[k].upper - motion_.dofs[k].lower);
        std::array<std::uint32_t, 3> cells{1, 1, 1}, halvings{};
        const auto halveWidest = [&] {
            const auto k =
                static_cast<std::size_t>(std::max_element(move.begin(), move.end()) - move.begin());
            move[k] /= 2;
            order_.push_back(k);
            return k;
        };
        for (std::uint32_t count = 1; count < mostGridCells[dofs - 1]; count *= 2) cells[halveWidest()] *= 2;
        cellHalvings_ = order_.size();
        grid_.unit_ = unitOf * std::accumulate(move.begin(), move.end(), 0.0);
        if (mostDivided[dofs - 1] > 0)
            for (std::uint32_t i = 0; i < partHalvings; ++i) ++halvings[halveWidest()];
        std::uint32_t stride = 1, shift = 0;
        grid_.dofs_ = dofs;
        for (std::size_t k = 0; k < dofs; ++k) {
            Axis& axis = grid_.axes_[k];
            const EvenParts even = evenParts(motion_.dofs[k], cells[k]);
            axis.cells = cells[k];
            axis.beyond = cells[k] + 1.0;
            axis.lower = even.lower;
            axis.width = even.width;
            axis.perWidth = 1 / axis.width;
            axis.before = axis.lower - axis.width;
            axis.stride = stride;
            stride *= cells[k] + 2;
            axis.halvings = halvings[k];
            axis.shift = shift;
            shift += halvings[k];
        }
        grid_.cells_.assign(stride, askCode);
        if (mostDivided[dofs - 1] > 0) grid_.partsOf_.assign(stride, undivided);
    }

    /// The least and the most that the smallest gap can be over a box; `near` receives the tests that may
    /// have it.
    GapRanges::Range smallest(const DofValues& centre, const DofValues& half,
                              std::span<const std::uint32_t> list, std::vector<std::uint32_t>& near) const {
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

    /// Finds the codes of a block: at once where one holds all over it, else of its halves. Each half has
    /// half of the effort, the second also what the first leaves; returns what both leave.
    std::uint64_t halve(const Block& block, std::span<const std::uint32_t> list, std::size_t depth,
                        std::uint64_t effort) {
        const Box box = grid_.box(block.first, block.size);
        DofValues centre{}, half{};
        double move = 0;
        for (std::size_t k = 0; k < grid_.dofs_; ++k) {
            centre[k] = box.lower[k] + 0.5 * (box.upper[k] - box.lower[k]);
            half[k] = 0.5 * (box.upper[k] - box.lower[k]) * (1 + GapRanges::wider);
            move += ranges_.weight(k) * half[k];
        }
        std::vector<std::uint32_t> near;
        const GapRanges::Range gap = smallest(centre, half, list, near);
        constexpr double mostCode = 255;
        const double told =
            gap.low > 0 ? std::min(freeCode + std::floor(gap.low / grid_.unit_), mostCode) : 0;
        const bool enough = gap.low > 0 && (told == mostCode || move <= enoughOf * gap.low);
        effort -= std::min<std::uint64_t>(effort, list.size());
        const bool touches = gap.high <= band_, cell = depth == cellHalvings_;
        if (touches || enough || depth == order_.size() || effort < 2 * near.size() ||
            (cell && (told > 0 || !divide(block.first)))) {
            write(block, depth, touches ? touchCode : static_cast<std::uint8_t>(told));
            return effort;
        }
        const std::size_t k = order_[depth];
        Block lower = block, upper = block;
        lower.size[k] = upper.size[k] = block.size[k] / 2;
        upper.first[k] += lower.size[k];
        const std::uint64_t left = halve(lower, near, depth + 1, effort / 2);
        effort = halve(upper, near, depth + 1, effort - effort / 2 + left);
        if (cell) dropUseless(block.first);
        return effort;
    }

    /// Gives the cell parts, all open. False: there are none left.
    bool divide(const Place& first) {
        const std::size_t divided = grid_.parts_.size() >> partHalvings;
        if (divided >= mostDivided[grid_.dofs_ - 1]) return false;
        grid_.partsOf_[grid_.cellOf(first)] = static_cast<std::uint16_t>(divided);
        grid_.parts_.resize((divided + 1) << partHalvings, askCode);
        return true;
    }

    /// Takes the parts of the cell that was divided last away again where all of them are open.
    void dropUseless(const Place& first) {
        const auto begin = grid_.parts_.end() - (std::ptrdiff_t(1) << partHalvings);
        if (std::any_of(begin, grid_.parts_.end(), [](std::uint8_t code) { return code != askCode; })) return;
        grid_.parts_.erase(begin, grid_.parts_.end());
        grid_.partsOf_[grid_.cellOf(first)] = undivided;
    }

    void write(const Block& block, std::size_t depth, std::uint8_t code) {
        if (code == askCode) asked_ += double(block.size[0]) * block.size[1] * block.size[2];
        if (depth > cellHalvings_)
            eachOf(block, {1, 1, 1}, [&](const Place& part) {
                grid_.parts_[(std::size_t(grid_.partsOf_[grid_.cellOf(part)]) << partHalvings) +
                             grid_.partOf(part)] = code;
            });
        else
            eachOf(block, {grid_.partsPerCell(0), grid_.partsPerCell(1), grid_.partsPerCell(2)},
                   [&](const Place& part) { grid_.cells_[grid_.cellOf(part)] = code; });
    }

    template <class Each>
    static void eachOf(const Block& block, const Place& step, Each each) {
        Place at = block.first;
        for (at[2] = block.first[2]; at[2] < block.first[2] + block.size[2]; at[2] += step[2])
            for (at[1] = block.first[1]; at[1] < block.first[1] + block.size[1]; at[1] += step[1])
                for (at[0] = block.first[0]; at[0] < block.first[0] + block.size[0]; at[0] += step[0])
                    each(at);
    }

    /// Where contact begins and ends within the cells that say Ask.
    void findPieces() {
        std::vector<Piece> pieces;
        const Axis& axis = grid_.axes_[0];
        for (std::uint32_t i = 0; i < axis.cells; ++i) {
            if (grid_.cells_[grid_.cellOf({i, 0, 0})] != askCode) continue;
            const double from = axis.lower + axis.width * i, hair = axis.width * GapRanges::wider;
            add(pieces, from - hair, Verdict::Ask);
            looks_ = 0;
            bracket(pieces, from - hair, from + axis.width + hair, all_, 0);
            add(pieces, from + axis.width + hair, Verdict::Ask);
            if (pieces.size() > mostPieces || looked_ > mostEffort) return;
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
        half[0] = 0.5 * (upper - lower) * (1 + GapRanges::wider);
        std::vector<std::uint32_t> near;
        const GapRanges::Range gap = smallest(centre, half, list, near);
        looked_ += list.size();
        if (gap.low > 0) return add(pieces, lower, Verdict::Free);
        if (gap.high <= band_) return add(pieces, lower, Verdict::Touch);
        if (depth == mostDepth || !(centre[0] > lower && centre[0] < upper) || ++looks_ > mostLooks)
            return add(pieces, lower, Verdict::Ask);
        bracket(pieces, lower, centre[0], near, depth + 1);
        bracket(pieces, centre[0], upper, near, depth + 1);
    }

    VerdictGrid& grid_;
    const Motion& motion_;
    GapRanges ranges_;
    double band_;
    std::vector<std::uint32_t> all_;
    std::vector<std::size_t> order_; ///< which DOF each halving cuts, of the limits and then of a cell
    std::size_t cellHalvings_ = 0;   ///< of the limits
    double asked_ = 0;               ///< parts of cells that are open
    int looks_ = 0;                  ///< for pieces of one cell
    std::uint64_t looked_ = 0;       ///< at tests, for pieces of all cells
};

VerdictGrid::VerdictGrid(const Motion& motion, std::span<const TablePair> pairs, double band) {
    if (motion.dofCount() < 1 || motion.dofCount() > mostDofs || pairs.empty()) return;
    Maker maker(*this, motion, pairs, band);
    if (maker.moves()) maker.make();
}

std::uint32_t VerdictGrid::cellOf(const Place& part) const {
    std::uint32_t at = 0;
    for (std::size_t k = 0; k < dofs_; ++k) at += ((part[k] >> axes_[k].halvings) + 1) * axes_[k].stride;
    return at;
}

std::uint32_t VerdictGrid::partOf(const Place& part) const {
    std::uint32_t at = 0;
    for (std::size_t k = 0; k < dofs_; ++k) at += (part[k] & (partsPerCell(k) - 1)) << axes_[k].shift;
    return at;
}

bool VerdictGrid::divided(const Place& part) const {
    return !partsOf_.empty() && partsOf_[cellOf(part)] != undivided;
}

std::uint8_t VerdictGrid::codeOf(const Place& part) const {
    const std::uint32_t cell = cellOf(part);
    if (!divided(part)) return cells_[cell];
    return parts_[(std::size_t(partsOf_[cell]) << partHalvings) + partOf(part)];
}

std::uint8_t VerdictGrid::codeWithin(const double* q) const {
    std::uint32_t cell = 0, part = 0;
    for (std::size_t k = 0; k < dofs_; ++k) {
        const Axis& axis = axes_[k];
        const double x = cellsInto(axis, q[k]) * partsPerCell(k); // a power of two: in the same cell again
        const auto at = static_cast<std::uint32_t>(static_cast<std::int32_t>(x));
        cell += (at >> axis.halvings) * axis.stride;
        part += (at & (partsPerCell(k) - 1)) << axis.shift;
    }
    if (partsOf_.empty() || partsOf_[cell] == undivided) return cells_[cell];
    return parts_[(std::size_t(partsOf_[cell]) << partHalvings) + part];
}

Verdict VerdictGrid::within(const double* q) const {
    if (dofs_ > 1) return verdictOf(codeWithin(q));
    Verdict verdict = Verdict::Ask;
    for (const Piece& piece : pieces_) {
        if (!(piece.from <= q[0])) break;
        verdict = piece.verdict;
    }
    return verdict;
}

VerdictGrid::Box VerdictGrid::box(const Place& first, const Place& size) const {
    Box found;
    for (std::size_t k = 0; k < dofs_; ++k) {
        const double width = axes_[k].width / partsPerCell(k);
        found.lower[k] = axes_[k].lower + width * first[k];
        found.upper[k] = axes_[k].lower + width * (double(first[k]) + size[k]);
    }
    return found;
}

} // namespace tss
