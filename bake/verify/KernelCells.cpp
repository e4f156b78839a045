#include "bake/verify/KernelCells.h"

#include "bake/verify/PoseBox.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <limits>

namespace tss::verify {

namespace {

/// How often a cell is halved where bounds over the whole of it do not suffice.
constexpr int mostHalvings = 12;

class Checker {
public:
    Checker(const Table& table, const PreparedTable& prepared)
        : table_(table), cells_(prepared.cells()), tests_(tests(table)), lanes_(prepared.lanes()),
          block_(tests_.size()), moving_(table.b.size()), low_(tests_.size()) {
        for (std::size_t i = 0; i < tests_.size(); ++i)
            block_[cells_.order()[i]] = static_cast<std::uint32_t>(i / lanes_);
        double reach = 0;
        for (const Sphere& s : table.a) size_ = std::max(size_, s.centre.norm() + s.radius);
        for (const Sphere& s : table.b) reach = std::max(reach, s.centre.norm() + s.radius);
        size_ = std::max(size_, coordinateBound(table.motion, reach));
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
    /// Bounds of every test's gap over the box: low_, and the smallest upper bound as the result.
    double bound(const Box& box) {
        const PoseBox pose(table_.motion, box, size_);
        for (std::size_t i = 0; i < table_.b.size(); ++i) moving_[i] = pose.carry(table_.b[i].centre, true);
        double high = std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < tests_.size(); ++p) {
            const Sphere &a = table_.a[tests_[p].a], &b = table_.b[tests_[p].b];
            const double reach = a.radius + b.radius + (table_.restGaps.empty() ? 0 : table_.restGaps[p]);
            const MovingPoint& point = moving_[tests_[p].b];
            const Vec3 apart = point.at - a.centre;
            const double distance = apart.norm();
            double along = 0, across = 0;
            for (std::size_t k = 0; k < pose.dofs(); ++k) {
                along += std::abs(apart.dot(point.velocity[k])) * pose.half(k);
                across += point.velocity[k].norm() * pose.half(k);
            }
            along = distance > 0 ? along / distance : across;
            const double hair = 1e-15 * size_;
            low_[p] = distance - std::min(point.move, along + point.bend) - reach - hair;
            high = std::min(
                high, std::min(distance + point.move, std::hypot(distance + along, across) + point.bend) -
                          reach + hair);
        }
        return high;
    }

    /// What the codes of the row claim and the bounds over the box do not give; empty: nothing.
    std::string unproven(std::uint32_t row, double high) const {
        const std::uint8_t reached = cells_.reachedCode(row);
        if (reached <= TableCells::contactCode && !(high <= 0))
            return fmt::format("cell {} says that every pose of it touches", row);
        if (reached < TableCells::farCode && cells_.code(high) > reached)
            return fmt::format("cell {} says that the smallest gap is smaller than it may be", row);
        std::uint8_t least = TableCells::farCode;
        for (std::size_t p = 0; p < low_.size(); ++p) {
            const std::uint8_t claimed = cells_.blockCode(row, block_[p]);
            least = std::min(least, claimed);
            if (cells_.code(low_[p]) < std::min(claimed, TableCells::nearCode))
                return fmt::format("cell {} leaves out test {}, which may come nearer", row, p);
            if (claimed > reached && !(low_[p] >= high))
                return fmt::format("cell {} leaves out test {}, which may be the nearest", row, p);
        }
        if (cells_.noneTouches(row) && least <= TableCells::contactCode)
            return fmt::format("cell {} says that no pose of it touches", row);
        return {};
    }

    std::string refute(std::uint32_t row, const Box& box, int halvings) {
        const std::string reason = unproven(row, bound(box));
        if (reason.empty() || halvings == mostHalvings) return reason;
        // Across each DOF in turn: cells are about as wide in all of them.
        const std::size_t dofs = box.lower.size(), k = std::size_t(halvings) % dofs;
        Box lower = box, upper = box;
        lower.upper[k] = upper.lower[k] = box.middle(k);
        const std::string first = refute(row, lower, halvings + 1);
        return first.empty() ? refute(row, upper, halvings + 1) : first;
    }

    const Table& table_;
    const TableCells& cells_;
    std::vector<SpherePair> tests_;
    std::uint32_t lanes_;
    std::vector<std::uint32_t> block_; ///< of each test
    double size_ = 0;
    std::vector<MovingPoint> moving_; ///< one a sphere of B
    std::vector<double> low_;         ///< one a test
};

/// The blocks hold every row once, to the bit.
bool blocksAreRows(const PreparedTable& prepared) {
    const std::size_t bytes = prepared.precision() == KernelPrecision::Float ? 4 : 8;
    const std::size_t lanes = prepared.lanes(), count = prepared.testCount();
    const std::size_t columns =
        prepared.form() == KernelForm::Fold ? foldColumns(prepared.rows().columns) : directColumns;
    const std::vector<std::uint32_t>& order = prepared.cells().order();
    const auto* blocks = static_cast<const std::byte*>(prepared.blocks().blocks);
    const auto* rows = static_cast<const std::byte*>(prepared.rows().blocks);
    std::vector<bool> seen(count);
    if (!order.empty() && order.size() != count) return false;
    for (std::size_t place = 0; place < count; ++place) {
        const std::size_t test = order.empty() ? place : order[place];
        if (test >= count || seen[test]) return false;
        seen[test] = true;
        for (std::size_t c = 0; c < columns; ++c) {
            const std::size_t in = (place / lanes * columns + c) * lanes + place % lanes;
            if (std::memcmp(blocks + in * bytes, rows + (test * columns + c) * bytes, bytes) != 0)
                return false;
        }
    }
    return true;
}

} // namespace

std::string refuteCells(const Table& table, const PreparedTable& prepared) {
    if (!blocksAreRows(prepared)) return "its blocks do not hold every test once";
    if (prepared.cells().empty()) return {};
    return Checker(table, prepared).refute();
}

} // namespace tss::verify
