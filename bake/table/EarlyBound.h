#pragma once
#include "bake/table/Table.h"

namespace tss {

/// How far apart the bodies may be where contact is reported, each the solid that its spheres were made for:
/// its openings filled. Their surfaces are no farther apart either, unless one body stands inside the other;
/// where that is excluded, boundEarly says so. None: not known.
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
