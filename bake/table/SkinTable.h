#pragma once
#include "bake/table/Table.h"

namespace tss {

/// The table of a skin over muscles: which skin spheres some muscle sphere can come to (METHOD 6.2). Skin
/// that is in no row is not touched at all.
struct SkinTable {
    Table table; ///< a: skin spheres, b: muscle spheres at activation 0, both in the skin's frame; no DOFs
    std::vector<std::uint32_t> skinVertices; ///< #a: the skin vertex that each skin sphere rides on
    std::vector<std::uint32_t> muscleOf;     ///< #b: index in the skin's list of muscles
    double travel =
        0; ///< how far a skin vertex may stray from rest for the table to be complete, scene units
};

} // namespace tss
