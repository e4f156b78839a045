#pragma once
#include <cstdint>
#include <vector>

namespace tss {

/// A small set of columns that meets every row, and how small it could be at best.
struct SetCover {
    std::vector<std::uint32_t> chosen; ///< rising
    double lowerBound = 0;             ///< no cover has fewer columns; from the Lagrangian dual, rounded up
};

/// Set cover. rows[r]: the columns any one of which answers row r, not empty, rising. Exact reductions first
/// (dominated rows and columns, rows with one column), then subgradient steps of the Lagrangian relaxation,
/// each with a greedy repair and without redundant columns. Deterministic.
SetCover coverRows(std::vector<std::vector<std::uint32_t>> rows);

} // namespace tss
