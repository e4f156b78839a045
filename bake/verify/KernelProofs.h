#pragma once
#include "bake/table/TableKernels.h"
#include "bake/verify/ExactPose.h"

#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace tss::verify {

/// A row of numbers as a kernel reads it, float or double.
class StoredRow {
public:
    /// rows: one after the other, or in blocks of some lanes.
    StoredRow(const PreparedTable& prepared, const KernelData& rows, std::size_t row, std::size_t lanes = 1)
        : single_(prepared.precision() == KernelPrecision::Float), lanes_(lanes) {
        const bool fold = prepared.form() == KernelForm::Fold;
        width_ = fold ? foldColumns(rows.columns) : directColumns;
        first_ = static_cast<const std::byte*>(rows.blocks) +
                 (row / lanes * width_ * lanes + row % lanes) * numberSize();
    }
    double operator[](std::size_t column) const {
        return single_ ? read<float>(column) : read<double>(column);
    }
    double fromEnd(std::size_t column) const { return (*this)[width_ - column]; }
    /// The number of its test.
    std::int64_t number() const {
        return single_ ? read<std::int32_t>(width_ - 1) : read<std::int64_t>(width_ - 1);
    }
    /// To the bit.
    bool sameAs(const StoredRow& other) const {
        for (std::size_t c = 0; c < width_; ++c)
            if (std::memcmp(at(c), other.at(c), numberSize()) != 0) return false;
        return true;
    }

private:
    std::size_t numberSize() const { return single_ ? sizeof(float) : sizeof(double); }
    const std::byte* at(std::size_t column) const { return first_ + column * lanes_ * numberSize(); }
    template <class T>
    T read(std::size_t column) const {
        T value;
        std::memcpy(&value, at(column), sizeof(T));
        return value;
    }

    bool single_;
    std::size_t lanes_, width_ = 0;
    const std::byte* first_ = nullptr;
};

/// The rows of a table's tests, wherever its kernels have them: in the blocks of its clusters, or one after
/// the other.
class StoredTests {
public:
    explicit StoredTests(const PreparedTable& prepared);
    /// The blocks hold each test once, and as its row has it where there are rows.
    bool eachOnce() const { return eachOnce_; }
    StoredRow operator[](std::size_t test) const;

private:
    const PreparedTable& prepared_;
    std::vector<std::uint32_t> place_; ///< of each test in the blocks
    bool eachOnce_ = false;
};

struct Bounds {
    double low, high; ///< how far a kernel's number may be below and above the exact one
};

/// Errors of what a kernel works out for one pair.
struct PairErrors {
    Bounds sign;   ///< of the squared distance less the squared contact distance, where that is about 0
    double square; ///< of the squared distance, at gaps asked for
};

/// Errors of the fold, pair by pair.
class FeatureFormErrors {
public:
    FeatureFormErrors(const Table& table, const PreparedTable& prepared, const std::vector<Exact>& tests);

    PairErrors of(std::size_t pair, const Exact& test) const;

private:
    double rounding(double constant, const std::vector<double>& products, double shared, double result) const;

    const PreparedTable& prepared_;
    const FeatureForm& fold_;
    double u_;
    std::vector<Real> farthest_; ///< of the squared distances that `exact_` was made from, one per test
    std::vector<std::vector<Real>> exact_;
    double rounding_ = 0;                       ///< of the poses that they come from
    std::vector<std::pair<Real, Real>> ranges_; ///< of the products of factors
    std::vector<std::size_t> columns_, sharedColumns_;
};

/// Errors of the direct kernel: x = R b + t - a by axes, |x|^2 - contactDistance^2.
/// posed: how far a point may come out of the pose that the kernel is given.
PairErrors directErrors(const PreparedTable& prepared, const StoredRow& row, const Exact& test,
                        double farthest, double posed);

/// The direct kernel's pose at values where every DOF's polynomial is known by them: in double, because
/// rounding to float is counted where the kernel reads. Of more DOFs, and of paths, nothing follows between
/// the values, and what was tried has to do; there angles far from the middle of their limits round as well.
class DirectPose {
public:
    DirectPose(const Table& table, const PreparedTable& prepared, const std::vector<Exact>& tests);

    /// What rounding may do to a point on its way, at any values.
    double rounding() const { return rounding_; }
    /// What the kernel does is no more than rounding.
    bool agrees() const { return worst_ <= rounding_; }
    /// The same for the features of the pose at some values, which are rounded once more to float.
    bool agreesAt(const PreparedTable& prepared, const ExactPose& at, const TableFeatures& f) const;

private:
    const Motion& motion_;
    double reach_ = 0, rounding_ = 0, farRounding_ = 0, worst_ = 0;
};

// What verifyKernel() shows of each part of a prepared table.

/// Whether blocks of lanes hold `count` rows, to the bit, in that order.
bool blocksAreRows(const PreparedTable& prepared, const KernelData& blocks, const KernelData& rows,
                   std::size_t count);

/// Whether rows of the direct form are those of these tests, to the bit, one after the other.
bool rowsAreTests(const PreparedTable& prepared, const KernelData& rows,
                  std::span<const std::uint32_t> tests);

/// Proves, with the verifier's own bounds of motion, that the cells of a prepared table leave out no test
/// that matters: in every cell, tests of a block left out of a yes-or-no query stay apart, those left out
/// under a margin stay above it, those left out of the smallest gap never have it; and where a cell answers
/// by itself, some test touches all over it. Returns what does not hold; empty: proven.
std::string refuteCells(const Table& table, const PreparedTable& prepared);

/// Proves of the clusters of a prepared table that none is passed over that has a test to be asked: each of
/// its tests is within the pair of spheres that bounds it, by the triangle inequality at any pose, and what
/// the kernel rounds about that pair does not hide that it is near. Returns what does not hold; empty:
/// proven. posed: how far a point may come out of the pose that the kernel is given.
std::string refuteClusters(const PreparedTable& prepared, const std::vector<Exact>& tests, double posed);

/// Proves, with the verifier's own bounds of motion, what the verdict grid of a prepared table says of every
/// cell and every piece between: where it says that tests touch some gap is at most signBand(), where it says
/// that none does all are above 0 and above the clearance that it states. Returns what does not hold; empty:
/// proven.
std::string refuteVerdicts(const Table& table, const PreparedTable& prepared);

} // namespace tss::verify
