#pragma once
#include "bake/table/TableKernels.h"

#include <span>
#include <string>

namespace tss::verify {

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

} // namespace tss::verify
