#pragma once
#include "bake/table/PreparedTable.h"

#include <string>
#include <vector>

namespace tss {

/// What came out of checking a table's run-time kernel.
struct KernelVerdict {
    bool proven = false;
    std::string reason; ///< why not; empty when proven
    double early = 0;   ///< proven: `hit` is false wherever the table's gap is larger than this, scene units
    double gapOff =
        0; ///< proven: `gap` is off by no more than this down to the table's depth and up to its margin
    double seen = 0; ///< the largest difference of `gap` from T(q) at the poses tried
};

/// Poses spread over the limits, and the table's gap there in extended precision: the same for all kernels.
struct TriedPoses {
    std::vector<std::vector<double>> values; ///< of the joint
    std::vector<long double> gaps;           ///< scene units
};
TriedPoses posesToTry(const Table& table);

/// Proves, from the numbers that the kernel reads and with code of its own, what PreparedTable promises about
/// rounding for every pose of the limits (METHOD 3.6, 4): `hit` is never false where some test's gap is <= 0
/// nor true beyond signBand(), and `gap` is off by no more than gapBand(). The fold: what it stores, and T(q)
/// itself in extended precision, are polynomials of the same few products of factors; the difference of their
/// coefficients bounds their difference everywhere, to which the rounding of the kernel's sums is added. Then
/// the poses are tried as they are, and what cells leave out is proven not to matter (KernelProofs.h).
KernelVerdict verifyKernel(const Table& table, const PreparedTable& prepared, const TriedPoses& poses);

} // namespace tss
