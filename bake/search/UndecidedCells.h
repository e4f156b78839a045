#pragma once
#include "bake/base/Progress.h"
#include "bake/motion/MotionBound.h"
#include "bake/spheres/SphereSet.h"

#include <optional>

namespace tss {

/// A part of Q as a tree of cells: a cell without parts belongs to it whole, one with parts only as far as
/// they.
struct CellTree {
    Cell cell;
    std::vector<CellTree> parts;

    std::size_t leaves() const;
};

/// The whole of Q as one cell.
CellTree wholeQ(const Motion& motion);

/// Conservative spheres of a body.
struct LevelSpheres {
    SphereSet spheres;
    std::vector<double> inner; ///< for each the radius of the ball about its centre that is inside the body
    std::vector<char> region;  ///< for each whether it stands for what overlaps at rest; empty: none does
};

struct UndecidedOptions {
    double resolution = 0; ///< cells in which B moves less than this are not cut further, scene units, > 0
    double margin = 0;     ///< contact is wanted to this distance, >= 0
    double depth = 0;      ///< a hit less deep than this is not decided yet, >= 0 (gap-true tables)
};

/// What is left of a part of Q when all cells are dropped in which the spheres already tell the truth
/// (METHOD 1.4): a pair of inscribed spheres fires all over the cell (a true hit), or no pair of conservative
/// ones can touch in it (truly free). Pairs of the region that overlaps at rest are
/// left out. Nothing: every pose is decided. Stopped through progress, what was not
/// looked at stays. The same for any number of threads.
struct Undecided {
    std::optional<CellTree> cells;
    bool hits = false; ///< some cell was dropped as a true hit
};
Undecided undecidedCells(const LevelSpheres& a, const LevelSpheres& b, const Motion& motion,
                         const CellTree& from, const UndecidedOptions& options,
                         const Progress& progress = {});

} // namespace tss
