#pragma once
#include "bake/table/TableKernels.h"
#include "bake/verify/ExactPose.h"

namespace tss::verify {

/// A row of numbers as a kernel reads it, float or double.
class StoredRow {
public:
    StoredRow(const PreparedTable& prepared, std::size_t row)
        : StoredRow(prepared, prepared.kernels().rows(), row) {}
    StoredRow(const PreparedTable& prepared, const KernelData& rows, std::size_t row)
        : single_(prepared.precision() == KernelPrecision::Float), data_(rows.blocks) {
        const bool fold = prepared.form() == KernelForm::Fold;
        width_ = fold ? foldColumns(rows.columns) : directColumns;
        first_ = row * width_;
    }
    double operator[](std::size_t column) const {
        return single_ ? double(static_cast<const float*>(data_)[first_ + column])
                       : static_cast<const double*>(data_)[first_ + column];
    }
    double fromEnd(std::size_t column) const { return (*this)[width_ - column]; }

private:
    bool single_;
    const void* data_;
    std::size_t width_ = 0, first_ = 0;
};

/// What of the error of a squared distance does not depend on the pair's own numbers.
struct Bounds {
    double low, high; ///< how far a kernel's number may be below and above the exact one
};

/// The claim about one pair from the errors of its squared distance less its squared contact distance
/// (`sign`, where that is about 0) and of its squared distance (`square`, at gaps asked for).
struct PairErrors {
    Bounds sign;
    double square;
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
/// the values, and what was tried has to do.
class DirectPose {
public:
    DirectPose(const Table& table, const PreparedTable& prepared, const std::vector<Exact>& tests);

    /// What rounding may do to a point on its way, at any values.
    double rounding() const { return rounding_; }
    /// What the kernel does is no more than rounding.
    bool agrees() const { return worst_ <= rounding_; }
    /// The same of what it is given at some values, rounded once more to float.
    bool agreesAt(const PreparedTable& prepared, const ExactPose& at, const TableFeatures& f) const;

private:
    const Motion& motion_;
    double reach_ = 0, rounding_ = 0, worst_ = 0;
};

} // namespace tss::verify
