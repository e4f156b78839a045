#pragma once
#include "bake/motion/MotionFrame.h"

namespace tss {

/// Linear inequalities normal . y >= bound on n unknowns, the normals of unit length, packed in one array
/// since the solver goes through hundreds of them again and again.
class QpRows {
public:
    QpRows() = default;
    explicit QpRows(std::size_t room) : numbers_(room * (maxDofs + 1)) {}

    /// Removes all rows; those added next have n unknowns.
    void clear(int n) {
        n_ = n;
        count_ = 0;
    }
    /// Adds a row, to be filled in: n numbers of its normal, then its bound. Grows the array where needed.
    double* add() {
        const std::size_t first = stride() * std::size_t(count_++);
        if (first + stride() > numbers_.size()) numbers_.resize(2 * (first + stride()));
        return numbers_.data() + first;
    }

    const double* normal(int row) const { return numbers_.data() + stride() * std::size_t(row); }
    double bound(int row) const { return normal(row)[n_]; }
    void setBound(int row, double bound) { numbers_[stride() * std::size_t(row) + std::size_t(n_)] = bound; }
    int unknowns() const { return n_; }
    int count() const { return count_; }

private:
    std::size_t stride() const { return std::size_t(n_) + 1; }
    int n_ = 0, count_ = 0;
    std::vector<double> numbers_;
};

/// The rows that are active at a nearest point, with a positive multiplier.
struct QpActive {
    int count = 0;
    std::array<int, maxDofs> rows{};
};

/// The point nearest to the origin that meets every row: the dual active-set method of Goldfarb and Idnani
/// (Mathematical Programming 27, 1983) for an identity Hessian. A row counts as met within `tolerance`.
/// Returns false where no point meets them all; y is then of no use. Allocates nothing.
bool nearestToOrigin(const QpRows& rows, double tolerance, DofValues& y, QpActive* active = nullptr);

} // namespace tss
