#pragma once
#include "bake/table/KernelTarget.h"
#include "bake/table/VerdictGrid.h"

#include <memory>
#include <optional>
#include <vector>

namespace tss {

struct MotionFrame;
struct Table;
struct TableContact;
struct TablePair;
class TableKernels;

enum class KernelForm { Fold, Direct };
enum class KernelPrecision { Float, Double };

const char* name(KernelForm form);
const char* name(KernelPrecision precision);

/// Whether a table gets cells (TableCells.h). Auto: where they leave out much.
enum class CellUse { Auto, Never, Always };

/// What to prepare a table for. What is not given is chosen by METHOD 4: the fold up to 10 features, float
/// where its rounding band is within epsilon / 10, or for a table without epsilon, within a thousandth of
/// what its spheres are off the meshes anyway.
struct PrepareOptions {
    KernelTarget target = KernelTarget::Best; ///< must be available
    std::optional<KernelForm> form;           ///< the fold is not to be had for every motion
    std::optional<KernelPrecision> precision;
    CellUse cells = CellUse::Auto; ///< where nothing moves there are none
    double poseError = 0; ///< how far poses that are given may be off at the spheres' centres, scene units
};

/// A pose as the kernels want it. Made by PreparedTable::features, good for that table only.
struct TableFeatures {
    static constexpr std::size_t room = 16;
    union {
        alignas(64) double doubles[room];
        float floats[room];
    };
    std::uint32_t cell = 0; ///< where the pose is among the table's cells
    TableFeatures() : doubles{} {}
};

struct TableGap {
    double gap = 0; ///< smallest gap, off by at most gapBand(); the largest float or more for an empty table
    int test = -1;  ///< index of the test that gives it, -1 for an empty table
};

/// Poses of many instances, each value of all of them contiguous: floats or doubles as the table takes them.
struct InstanceFeatures {
    std::vector<float> floats;
    std::vector<double> doubles;
    std::uint32_t count = 0, stride = 0;
};

/// A table as it is queried at run time (METHOD 4): squared distances linear in a few features of the pose,
/// or the direct transform, in float where that is exact enough, with the instructions of this processor.
/// Immutable once made; any number of threads and instances share one. No query allocates, locks, throws or
/// calls anything virtual; the kernels are chosen when it is made.
class PreparedTable {
public:
    /// Throws InputError where the options ask for what this table, build or processor does not have.
    explicit PreparedTable(const Table& table, const PrepareOptions& options = {});
    PreparedTable(PreparedTable&&) noexcept;
    PreparedTable& operator=(PreparedTable&&) noexcept;
    ~PreparedTable();

    /// Some test touches. q: one finite value per DOF, within the limits. Never false where a gap is <= 0,
    /// and true only where one is <= signBand(): the kernels go farther by what they may round. Most poses
    /// are in a cell of the limits that has the answer.
    bool hit(const double* q) const {
        if (const Verdict known = verdicts_.atOnce(q); known != Verdict::Ask) return known == Verdict::Touch;
        return hitAsked(q);
    }

    /// Features of a pose, from its values or from the pose itself, B to A, 3 by 4, row-major, rotation first
    /// (of the direct form without cells only). What is asked with them is asked of the kernels at once.
    void features(const double* q, TableFeatures& out) const;
    void features(const std::array<double, 12>& pose, TableFeatures& out) const;
    bool hit(const TableFeatures& f) const;

    /// The smallest gap, within gapBand() for gaps up to the table's margin, and its test.
    TableGap gap(const double* q) const;
    TableGap gap(const TableFeatures& f) const;

    /// The smallest gap with point, normal and gradient (Contact.h); `frame` is frame(q) of the same pose. Of
    /// the gradient dofCount() values are written.
    TableContact contact(const double* q) const;
    void contact(const TableFeatures& f, const MotionFrame& frame, TableContact& out) const;

    /// T(q) and how each DOF moves B from there, for `contact`.
    void frame(const double* q, MotionFrame& out) const;

    /// Numbers of all tests whose gap may be at most margin (>= 0; none is missed within the band, but of
    /// those whose contact distance is below 0, which never touch), always in the same order. out: room for
    /// testRoom() numbers. Returns how many. From the values no features are made where the cell of q has no
    /// test to be asked.
    std::uint32_t testsWithin(const TableFeatures& f, double margin, std::uint32_t* out) const;
    std::uint32_t testsWithin(const double* q, double margin, std::uint32_t* out) const;

    /// Many instances at once. q: count rows of one value per DOF. Allocates when `out` has to grow.
    void instanceFeatures(const double* q, std::uint32_t count, InstanceFeatures& out) const;
    /// hit[i] = 1 where instance i touches, else 0. hit: room for f.count.
    void hits(const InstanceFeatures& f, std::uint8_t* hit) const;

    std::size_t testCount() const;
    std::size_t testRoom() const;
    std::size_t dofCount() const;
    TablePair pair(std::size_t test) const;
    const VerdictGrid& verdicts() const { return verdicts_; } ///< empty for more than three DOFs

    KernelForm form() const;
    KernelPrecision precision() const;
    KernelTarget target() const;
    std::size_t bytes() const; ///< of what a query reads

    /// `hit` is false wherever the table's gap is larger than this, scene units, and true wherever it is <=
    /// 0.
    double signBand() const;
    /// `gap` is off by no more than this for gaps down to -gapDepth and up to gapMargin of the table.
    double gapBand() const;

    const TableKernels& kernels() const { return *kernels_; }

private:
    bool hitAsked(const double* q) const;

    VerdictGrid verdicts_;
    std::unique_ptr<const TableKernels> kernels_;
};

} // namespace tss
