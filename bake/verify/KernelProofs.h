#pragma once
#include "bake/table/PreparedTable.h"
#include "bake/table/TableKernels.h"
#include "bake/verify/KernelErrors.h"

#include <span>
#include <string>

namespace tss::verify {

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
