#pragma once
#include "bake/base/Progress.h"
#include "bake/motion/MotionBound.h"
#include "bake/spheres/SphereSet.h"

#include <optional>

namespace tss {

/// A subset of Q as a tree of cells: the union of the cells of all leaves. The cell of an inner node contains
/// those of its children, which need not fill it.
struct CellTree {
    Cell cell;
    std::vector<CellTree> children; ///< empty: a leaf

    std::size_t leaves() const;
};

/// The whole of Q as one cell.
CellTree wholeQ(const Motion& motion);

/// Conservative spheres of a body, each with the ball about the same centre that the body contains.
struct LevelSpheres {
    SphereSet spheres;
    std::vector<double> inner; ///< #spheres: radius of the inscribed ball, scene units
    std::vector<char> region;  ///< #spheres: 1 where it covers the region that overlaps at rest; empty: none
};

struct UndecidedOptions {
    double resolution = 0; ///< cells in which B moves less than this are not cut further, scene units, > 0
    double margin = 0;     ///< pairs up to this gap are of interest, scene units, >= 0
    double depth = 0; ///< contact decides a cell only from this depth on, scene units, >= 0 (gap-true tables)
};

/// The part of Q in which the spheres do not decide yet whether the bodies are in contact.
struct Undecided {
    std::optional<CellTree> cells; ///< nothing: every pose is decided
    bool hits = false;             ///< some cell was dropped because the bodies are in contact all over it
};

/// Drops the cells of `from` that the spheres decide (METHOD 1.4): contact, where a pair of inscribed balls
/// overlaps at every pose of the cell; no contact, where no pair of conservative spheres can touch in it.
/// Pairs of which both spheres cover the region that overlaps at rest are not looked at. Stopped through
/// progress, cells that were not looked at count as undecided. The same for any number of threads.
Undecided undecidedCells(const LevelSpheres& a, const LevelSpheres& b, const Motion& motion,
                         const CellTree& from, const UndecidedOptions& options,
                         const Progress& progress = {});

} // namespace tss
