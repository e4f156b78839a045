#pragma once
#include "bake/motion/Motion.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tss {

struct TablePair;

enum class Verdict : std::uint8_t { Ask, Touch, Free };

/// The limits of one to three DOFs cut into cells, one byte each: whether the tests touch all over the cell,
/// or how far they all stay apart in it, or that this is open (METHOD 4). Most poses get their verdict from
/// the values of the DOFs alone, without sine and cosine. Open cells of two and three DOFs are cut into 64
/// parts of a byte each; with one DOF the values at which contact begins and ends are kept, so that next to
/// none are asked.
class VerdictGrid {
public:
    static constexpr std::size_t mostDofs = 3;

    /// Empty for no DOF and for more than those, and where nothing moves. `band`: a test counts as touching
    /// up to this gap.
    VerdictGrid() = default;
    VerdictGrid(const Motion& motion, std::span<const TablePair> pairs, double band);

    bool empty() const { return dofs_ == 0; }

    /// What every pose of the cell of q has in common, without a look at the parts of open cells: Ask there,
    /// beyond the limits, and where the grid is empty.
    Verdict atOnce(const double* q) const { return verdictOf(cells_[cellAt(q)]); }

    /// What is known where atOnce() says Ask: by the parts, or the values at which contact begins and ends.
    Verdict within(const double* q) const;

    /// Both.
    Verdict verdict(const double* q) const {
        const Verdict known = atOnce(q);
        return known == Verdict::Ask ? within(q) : known;
    }

    /// No test comes nearer than this anywhere in the cell of q, or in the part of it, scene units; 0: not
    /// known.
    double clearance(const double* q) const {
        const std::uint8_t code = cells_[cellAt(q)];
        return code == askCode ? clearanceWithin(q) : clearanceOf(code);
    }

    std::size_t bytes() const {
        return cells_.size() + parts_.size() + partsOf_.size() * sizeof(partsOf_[0]) +
               pieces_.size() * sizeof(Piece);
    }

    /// The share of the limits in which tests must be asked, 0 to 1.
    double asked() const { return asked_; }

    /// For those who check it (verify): places count the parts of cells along each DOF, 0 the first.
    using Place = std::array<std::uint32_t, 3>;
    struct Box {
        DofValues lower{}, upper{};
    };
    std::uint32_t cellCount(std::size_t dof) const { return axes_[dof].cells; }
    std::uint32_t partsPerCell(std::size_t dof) const { return 1u << axes_[dof].halvings; }
    /// Whether the cell that has this part is open, and what its parts say is known.
    bool divided(const Place& part) const;
    /// The values of `size` parts a DOF, from `first` on.
    Box box(const Place& first, const Place& size) const;
    Verdict verdictOf(const Place& part) const { return verdictOf(codeOf(part)); }
    double clearanceOf(const Place& part) const { return clearanceOf(codeOf(part)); }
    /// With one DOF: the verdict in open cells from this value on, up to that of the next piece.
    struct Piece {
        double from = 0;
        Verdict verdict = Verdict::Ask;
    };
    const std::vector<Piece>& pieces() const { return pieces_; }

private:
    static constexpr std::uint8_t askCode = 0, touchCode = 1, freeCode = 2;
    static constexpr std::uint32_t partHalvings = 6; ///< of a cell that is divided
    static constexpr std::uint16_t undivided = 0xffff;

    struct Axis {
        double before = 0, perWidth = 0; ///< a cell's width before the first cell; cells per unit
        double rim = 0, beyond = 1;      ///< the first place and the last: 0, and cells and one
        std::uint32_t stride = 1;
        std::uint32_t cells = 1;
        std::uint32_t halvings = 0, shift = 0; ///< of a cell into its parts; of their places within a cell
        double lower = 0, width = 0;           ///< of the first cell
    };
    class Maker;

    static Verdict verdictOf(std::uint8_t code) {
        return code > touchCode ? Verdict::Free : static_cast<Verdict>(code);
    }
    double clearanceOf(std::uint8_t code) const { return code > freeCode ? (code - freeCode) * unit_ : 0; }

    /// About the cells lies a rim of one cell, which says Ask; what is no number is in it too.
    static double cellsInto(const Axis& axis, double q) {
        // Without std::min, std::max and constants, of which compilers make branches.
        const double x = (q - axis.before) * axis.perWidth, most = x < axis.beyond ? x : axis.beyond;
        return most > axis.rim ? most : axis.rim;
    }
    static std::size_t along(const Axis& axis, double q) {
        return static_cast<std::size_t>(static_cast<std::int64_t>(cellsInto(axis, q)));
    }
    /// Written out for each number of DOFs: a loop over them would take as long again.
    std::size_t cellAt(const double* q) const {
        if (dofs_ == 1) [[likely]]
            return along(axes_[0], q[0]);
        if (dofs_ == 0) [[unlikely]]
            return 0;
        const std::size_t two = along(axes_[0], q[0]) + along(axes_[1], q[1]) * axes_[1].stride;
        return dofs_ == 2 ? two : two + along(axes_[2], q[2]) * axes_[2].stride;
    }
    std::uint32_t cellOf(const Place& part) const;
    std::uint32_t partOf(const Place& part) const; ///< its place within its cell
    std::uint8_t codeOf(const Place& part) const;
    std::uint8_t codeWithin(const double* q) const;

    double clearanceWithin(const double* q) const { return clearanceOf(codeWithin(q)); }

    std::size_t dofs_ = 0;
    std::array<Axis, 3> axes_{};
    std::vector<std::uint8_t> cells_{askCode};
    std::vector<std::uint16_t> partsOf_; ///< one per cell: where its parts are, in units of a divided cell's
    std::vector<std::uint8_t> parts_;
    std::vector<Piece> pieces_;
    double unit_ = 0; ///< of clearances
    double asked_ = 1;
};

} // namespace tss
