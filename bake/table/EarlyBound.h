#pragma once
#include "bake/table/Table.h"

namespace tss {

/// How far apart the bodies may be where contact is reported, each the solid that its spheres were made for:
/// its openings filled. Their surfaces are no farther apart either, unless one body stands inside the other;
/// where that is excluded, boundEarly says so. < 0: not known.
inline double earlyOfSolids(const Table& table) {
    const double a = table.record.fitA.protrusion, b = table.record.fitB.protrusion;
    return table.certified && a >= 0 && b >= 0 ? a + b + table.epsilon : -1;
}

/// The same where that is known, else boundEarly.
inline double earlyOfTable(const Table& table) {
    const double solids = earlyOfSolids(table);
    return solids >= 0 ? solids : table.boundEarly;
}

} // namespace tss
