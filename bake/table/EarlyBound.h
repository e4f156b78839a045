#pragma once
#include "bake/table/Table.h"

namespace tss {

/// A bound of the distance of the two solids, openings filled, where contact is reported: both protrusions
/// and epsilon. It bounds the distance of the surfaces too, unless one body stands wholly inside the other;
/// Table::boundEarly holds in that case as well. None: not known.
inline std::optional<double> earlyOfSolids(const Table& table) {
    const std::optional<double> a = table.record.fitA.protrusion, b = table.record.fitB.protrusion;
    if (!table.certified || !a || !b) return std::nullopt;
    return *a + *b + table.epsilon;
}

/// The same where that is known, else boundEarly.
inline std::optional<double> earlyOfTable(const Table& table) {
    const std::optional<double> solids = earlyOfSolids(table);
    return solids ? solids : table.boundEarly;
}

} // namespace tss
