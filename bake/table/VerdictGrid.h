#pragma once
#include "bake/motion/MotionFrame.h"
#include "bake/table/TablePairs.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace tss {

enum class Verdict : std::uint8_t { Ask, Touch, Free };

/// The limits of one to three DOFs cut into many small cells, one byte each: whether the tests touch all over
/// the cell, or how far they all stay apart in it, or that the tests themselves must be asked (METHOD 4).
/// Most poses get their verdict from the values of the DOFs alone, without sine and cosine. With one DOF the
/// values at which contact begins and ends are kept as well, so that next to none are asked.
class VerdictGrid {
public:
    VerdictGrid() = default;
    /// Empty for no DOF and for more than three, and where nothing moves. `band`: a test counts as touching
    /// up to this gap.
    VerdictGrid(const Motion& motion, std::span<const TablePair> pairs, double band);

    bool empty() const { return codes_.empty(); }

    /// What every pose of the cell of q has in common. Beyond the limits: Ask.
    Verdict verdict(const double* q) const {
        const std::uint8_t code = codes_[cellAt(q)];
        if (code != askCode) return code == touchCode ? Verdict::Touch : Verdict::Free;
        return pieces_.empty() ? Verdict::Ask : pieceAt(q[0]);
    }

    /// No test comes nearer than this anywhere in the cell of q, scene units; 0: not known.
    double clearance(const double* q) const {
        const std::uint8_t code = codes_[cellAt(q)];
        return code < freeCode ? 0 : (code - freeCode) * unit_;
    }

    std::size_t bytes() const { return codes_.size() + pieces_.size() * sizeof(Piece); }

    /// The share of the limits in which tests must be asked, 0 to 1.
    double asked() const { return asked_; }

    /// For those who check it (verify): the cells, each with the values it stands for and what it says.
    struct Box {
        DofValues lower{}, upper{};
    };
    std::uint32_t cellCount(std::size_t dof) const { return axes_[dof].cells; }
    Box box(const std::array<std::uint32_t, 3>& cell) const;
    Verdict verdictOf(const std::array<std::uint32_t, 3>& cell) const;
    double clearanceOf(const std::array<std::uint32_t, 3>& cell) const;
    /// Of one DOF: from this value on, up to the next one's, this is the verdict where a cell says Ask.
    struct Piece {
        double from = 0;
        Verdict verdict = Verdict::Ask;
    };
    const std::vector<Piece>& pieces() const { return pieces_; }

private:
    static constexpr std::uint8_t askCode = 0, touchCode = 1, freeCode = 2;

    struct Axis {
        double before = 0, perWidth = 0; ///< a cell's width before the first cell; cells per unit
        double beyond = 1;               ///< cells and one
        std::uint32_t stride = 1;
        std::uint32_t cells = 1;
        double lower = 0, width = 0; ///< of the first cell
    };
    class Maker;

    /// About the cells of the limits lies a rim of one cell, which says Ask; what is no number is in it too.
    std::uint32_t cellAt(const double* q) const {
        std::uint32_t cell = 0;
        for (std::size_t k = 0; k < dofs_; ++k) {
            const Axis& axis = axes_[k];
            const double x = std::min(std::max(0.0, (q[k] - axis.before) * axis.perWidth), axis.beyond);
            cell += static_cast<std::uint32_t>(static_cast<std::int32_t>(x)) * axis.stride;
        }
        return cell;
    }
    std::uint32_t cellOf(const std::array<std::uint32_t, 3>& cell) const;
    Verdict pieceAt(double q) const;

    std::size_t dofs_ = 0;
    std::array<Axis, 3> axes_{};
    std::vector<std::uint8_t> codes_;
    std::vector<Piece> pieces_;
    double unit_ = 0; ///< of clearances
    double asked_ = 1;
};

} // namespace tss
