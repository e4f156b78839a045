#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/search/UndecidedCells.h"
#include "bake/spheres/Patches.h"

namespace tss {

/// Which of two bodies a surface belongs to: A stands, B moves.
enum class Side { A, B };

/// Finds the parts of one body's surface that come within `margin` of the other body's mesh at some pose of
/// the cells (METHOD 1.4). Conservative: what is left out stays farther away at all their poses, and what is
/// kept may stay a few times `size` farther away than the margin. Patches are halved until their radius is at
/// most `size`, scene units, > 0. patches: of the body on `side`, in its own frame. other: the mesh of the
/// other body, in its own frame. share: of the usual limit of work, in (0, 1]; with less work more surface is
/// kept. The same for any number of threads.
std::vector<Patch> findNearSurface(std::span<const Patch> patches, Side side, const MeshQuery& other,
                                   const Motion& motion, const CellTree& cells, double size, double margin,
                                   double share = 1, const Progress& progress = {});

} // namespace tss
