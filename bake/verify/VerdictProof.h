#pragma once
#include "bake/table/PreparedTable.h"

#include <string>

namespace tss::verify {

/// Proves, with the verifier's own bounds of motion, what the verdict grid of a prepared table says of every
/// cell and every piece between: where it says that tests touch some gap is at most signBand(), where it says
/// that none does all are above 0 and above the clearance that it states. Returns what does not hold; empty:
/// proven.
std::string refuteVerdicts(const Table& table, const PreparedTable& prepared);

} // namespace tss::verify
