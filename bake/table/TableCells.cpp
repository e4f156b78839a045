#include "bake/table/TableCells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace tss {

namespace {

/// At most so many cells, and so many codes while they are made.
constexpr std::size_t mostCells = 1024, mostCodes = std::size_t(1) << 18;
/// Cells in which a test moves by less than this share of its reach are small enough.
constexpr double smallMove = 0.02;
/// Codes for the half of a cell's largest move.
constexpr double codesPerMove = 8;
/// By how much a cell's box is taken wider than it is, for rounding when a cell is looked up.
constexpr double wider = 1e-6;
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
        : cells_(cells), motion_(motion), pairs_(pairs), dofs_(motion.dofCount()) {
        double coordinate = motion.base.translation().norm();
        for (const Dof& dof : motion.dofs) {
            turns_.push_back(turnBound(dof));
            paths_ = paths_ || dof.kind == DofKind::Path;
            coordinate += 2 * dof.origin.norm() + std::max(std::abs(dof.lower), std::abs(dof.upper));
        }
        speeds_.resize(pairs.size() * dofs_);
        std::vector<double> reaches;
        for (std::size_t p = 0; p < pairs.size(); ++p) {
            speedBounds(motion, pairs[p].b, &speeds_[p * dofs_]);
            for (std::size_t k = 0; k < dofs_; ++k)
                weights_[k] = std::max(weights_[k], speeds_[p * dofs_ + k]);
            reaches.push_back(std::abs(pairs[p].reach));
            slack_ = std::max(slack_, pairs[p].a.norm() + pairs[p].b.norm() + reaches.back());
        }
        slack_ = 1e-13 * (slack_ + coordinate);
        std::nth_element(reaches.begin(), reaches.begin() + std::ptrdiff_t(reaches.size() / 2),
                         reaches.end());
        middleReach_ = reaches[reaches.size() / 2];
    }

    /// Cuts the limits, always across the DOF that moves most within a cell.
    void cut() {
        std::array<double, maxDofs> move{};
        std::array<int, maxDofs> halvings{};
        for (std::size_t k = 0; k < dofs_; ++k)
            move[k] = weights_[k] * (motion_.dofs[k].upper - motion_.dofs[k].lower);
        const std::size_t most = std::min(mostCells, mostCodes / pairs_.size());
        std::size_t count = 1;
        const auto whole = [&] {
            return std::accumulate(move.begin(), move.begin() + std::ptrdiff_t(dofs_), 0.0);
        };
        while (2 * count <= most && whole() > smallMove * middleReach_) {
            const auto k =
                static_cast<std::size_t>(std::max_element(move.begin(), move.end()) - move.begin());
            move[k] /= 2;
            ++halvings[k];
            order_.push_back(k);
            count *= 2;
        }
        cells_.dofs_ = dofs_;
        std::uint32_t stride = 1;
        for (std::size_t k = 0; k < dofs_; ++k) {
            const Dof& dof = motion_.dofs[k];
            Axis& axis = cells_.axes_[k];
            axis.cells = 1 << halvings[k];
            axis.stride = stride;
            stride *= static_cast<std::uint32_t>(axis.cells);
            // A little over the limits, so that what rounding puts beyond them has a cell.
            const double range = dof.upper - dof.lower;
            const double over = 1e-9 * range + 4 * std::numeric_limits<double>::epsilon() *
                                                   std::max(std::abs(dof.lower), std::abs(dof.upper));
            axis.lower = dof.lower - over;
            axis.width = (range + 2 * over) / axis.cells;
            axis.perWidth = axis.width > 0 ? 1 / axis.width : 0;
        }
        cellCount_ = count;
        const double cellMove = 0.5 * whole();
        cells_.perUnit_ = cellMove > 0 ? codesPerMove / cellMove : 0; // 0: nothing moves anything
        nearGap_ = cellMove / codesPerMove * evenCodes;
    }

    void find() {
        codes_.assign(cellCount_ * pairs_.size(), farCode);
        reached_.assign(cellCount_, farCode);
        visited_.clear();
        std::vector<std::uint32_t> all(pairs_.size());
        std::iota(all.begin(), all.end(), 0u);
        Piece limits;
        for (std::size_t k = 0; k < dofs_; ++k) limits.size[k] = cells_.axes_[k].cells;
        halve(limits, all, 0);
    }

    /// Blocks of tests that can touch in the same parts of the limits.
    void put(std::uint32_t lanes) {
        std::vector<std::uint32_t>& order = cells_.order_;
        order.resize(pairs_.size());
        std::iota(order.begin(), order.end(), 0u);
        if (lanes == 1) return;
        const std::size_t perPart = std::max<std::size_t>(1, cellCount_ / mostParts);
        std::vector<Parts> parts(pairs_.size(), Parts{});
        std::vector<int> counts(pairs_.size(), 0); // of parts
        std::vector<double> place(pairs_.size(), -1);
        for (std::size_t p = 0; p < pairs_.size(); ++p) {
            double sum = 0, count = 0;
            for (std::size_t i = 0; i < cellCount_; ++i) {
                if (codes_[visited_[i] * pairs_.size() + p] > contactCode) continue;
                const std::size_t part = i / perPart;
                parts[p][part / 64] |= std::uint64_t(1) << part % 64;
                sum += double(i);
                ++count;
            }
            if (count > 0) place[p] = sum / count;
            for (std::uint64_t word : parts[p]) counts[p] += std::popcount(word);
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t x, std::uint32_t y) { return place[x] < place[y]; });
        for (std::size_t first = 0; first < order.size(); first += lanes) {
            Parts block = parts[order[first]];
            const std::size_t last = std::min(order.size(), first + lanes);
            for (std::size_t i = first + 1; i < last; ++i) {
                const auto grown = [&](std::uint32_t p) {
                    int more = 0;
                    for (std::size_t w = 0; w < block.size(); ++w)
                        more += std::popcount(parts[p][w] & ~block[w]);
                    return more * 1024 - counts[p];
                };
                std::size_t best = i;
                int least = grown(order[i]);
                for (std::size_t j = i + 1; j < std::min(order.size(), i + orderWindow); ++j)
                    if (const int g = grown(order[j]); g < least) {
                        least = g;
                        best = j;
                    }
                // The others stay in their order.
                std::rotate(order.begin() + std::ptrdiff_t(i), order.begin() + std::ptrdiff_t(best),
                            order.begin() + std::ptrdiff_t(best) + 1);
                for (std::size_t w = 0; w < block.size(); ++w) block[w] |= parts[order[i]][w];
            }
        }
    }

    void write(std::uint32_t lanes) {
        const std::size_t blocks = (pairs_.size() + lanes - 1) / lanes;
        const std::size_t rowCodes =
            (blocks + headerCodes + codesPerGroup - 1) / codesPerGroup * codesPerGroup;
        cells_.rowCodes_ = static_cast<std::uint32_t>(rowCodes);
        cells_.rows_.assign((cellCount_ + 1) * rowCodes, farCode);
        std::fill_n(cells_.rows_.begin() + 1, blocks + 1, std::uint8_t(0));
        std::size_t looked = 0;
        for (std::size_t cell = 0; cell < cellCount_; ++cell) {
            std::uint8_t* row = &cells_.rows_[(cell + 1) * rowCodes];
            row[0] = reached_[cell];
            for (std::size_t i = 0; i < pairs_.size(); ++i) {
                std::uint8_t& block = row[headerCodes + i / lanes];
                block = std::min(block, codes_[cell * pairs_.size() + cells_.order_[i]]);
            }
            const std::uint8_t *first = row + headerCodes, *last = first + blocks;
            row[1] = *std::min_element(first, last);
            if (row[0] > contactCode)
                looked +=
                    std::size_t(std::count_if(first, last, [](std::uint8_t c) { return c <= contactCode; }));
        }
        cells_.looked_ = double(looked) / double(cellCount_ * blocks);
    }

private:
    struct Piece {
        std::array<std::int32_t, maxDofs> first{}, size{};
    };

    /// What a test's gap can be in a box about where `frame` is.
    struct Range {
        double low, high;
    };
    Range range(std::uint32_t p, const MotionFrame& frame, const DofValues& half) const {
        const TablePair& pair = pairs_[p];
        const double* speed = &speeds_[p * dofs_];
        const Vec3 centre = frame.pose * pair.b, apart = centre - pair.a;
        const double distance = apart.norm(), gap = distance - pair.reach;
        double move = 0;
        for (std::size_t k = 0; k < dofs_; ++k) move += speed[k] * half[k];
        const double off = move * wider + slack_;
        Range found{gap - move - off, gap + move + off};
        if (paths_ || !(distance > move)) return found;
        // To second order: a gap bends down no more than its point's way does, and up by what goes past it.
        double slope = 0, bend = 0, turning = 0;
        for (std::size_t k = 0; k < dofs_; ++k) {
            slope += std::abs(apart.dot(frame.twists[k].velocity(centre))) * half[k];
            const double turn = turns_[k] * half[k];
            bend += speed[k] * half[k] * (turn + 2 * turning);
            turning += turn;
        }
        slope /= distance;
        found.low = std::max(found.low, gap - slope - 0.5 * bend - off);
        found.high = std::min(found.high, gap + slope + 0.5 * (bend + move * move / (distance - move)) + off);
        return found;
    }

    void halve(const Piece& piece, const std::vector<std::uint32_t>& list, std::size_t depth) {
        DofValues centre{}, half{}, way;
        way.fill(1);
        for (std::size_t k = 0; k < dofs_; ++k) {
            const Axis& axis = cells_.axes_[k];
            centre[k] = axis.lower + axis.width * (piece.first[k] + 0.5 * piece.size[k]);
            half[k] = 0.5 * axis.width * piece.size[k] * (1 + wider);
        }
        MotionFrame frame;
        evaluateFrame(motion_, centre.data(), way.data(), frame);
        const bool leaf = depth == order_.size();
        std::size_t cell = 0;
        for (std::size_t k = 0; k < dofs_; ++k) cell += std::size_t(piece.first[k]) * cells_.axes_[k].stride;
        std::vector<double> lows(list.size());
        double reached = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < list.size(); ++i) {
            const Range found = range(list[i], frame, half);
            lows[i] = found.low;
            reached = std::min(reached, found.high);
        }
        // A test that is neither near nor ever the nearest does not matter here.
        const double matters = std::max(reached, nearGap_);
        std::vector<std::uint32_t> near;
        for (std::size_t i = 0; i < list.size(); ++i) {
            if (lows[i] > matters) continue;
            if (leaf)
                codes_[cell * pairs_.size() + list[i]] = cells_.code(lows[i]);
            else
                near.push_back(list[i]);
        }
        if (leaf) {
            reached_[cell] = cells_.code(reached);
            visited_.push_back(cell);
            return;
        }
        const std::size_t k = order_[depth];
        Piece lower = piece, upper = piece;
        lower.size[k] = upper.size[k] = piece.size[k] / 2;
        upper.first[k] += lower.size[k];
        halve(lower, near, depth + 1);
        halve(upper, near, depth + 1);
    }

    TableCells& cells_;
    const Motion& motion_;
    std::span<const TablePair> pairs_;
    std::size_t dofs_;
    std::vector<double> speeds_; ///< #pairs by #DOFs
    std::vector<double> turns_;  ///< one a DOF
    bool paths_ = false;
    DofValues weights_{};
    double slack_ = 0, middleReach_ = 0;
    double nearGap_ = 0;             ///< gaps up to it have codes up to nearCode
    std::vector<std::size_t> order_; ///< which DOF each halving cuts
    std::size_t cellCount_ = 1;
    std::vector<std::uint8_t> codes_;   ///< #cells by #pairs
    std::vector<std::uint8_t> reached_; ///< one a cell
    std::vector<std::size_t> visited_;  ///< cells in the order of halving, neighbours near one another
};

TableCells::TableCells(const Motion& motion, std::span<const TablePair> pairs, std::uint32_t lanes) {
    Maker maker(*this, motion, pairs);
    maker.cut();
    maker.find();
    maker.put(lanes);
    maker.write(lanes);
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
    Box found;
    for (std::size_t k = 0; k < dofs_; ++k) {
        const Axis& axis = axes_[k];
        const std::uint32_t at = (row - 1) / axis.stride % std::uint32_t(axis.cells);
        found.centre[k] = axis.lower + axis.width * (at + 0.5);
        found.half[k] = 0.5 * axis.width;
    }
    return found;
}

} // namespace tss
