#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/search/UndecidedCells.h"
#include "bake/spheres/Patches.h"

namespace tss {

/// Which of two bodies a surface belongs to: A stands, B moves.
enum class Side { A, B };

/// Finds the parts of one body's surface that come within `margin` of the other body's mesh at some pose of
/// the cells (METHOD 1.4). Nothing is lost: what is left out stays farther away at all their poses. What is
/// kept may stay a few `size` farther than the margin. Patches larger than `size` are halved. patches: of the
/// body on `side`, in its own frame. other: the mesh of the other body, in its own frame. size: radius of the
/// patches to end with, scene units, > 0. share: of the work that is done at most, in (0, 1]; with less of it
/// more surface is kept. The same for any number of threads.
std::vector<Patch> findNearSurface(std::span<const Patch> patches, Side side, const MeshQuery& other,
                                   const Motion& motion, const CellTree& cells, double size, double margin,
                                   double share = 1, const Progress& progress = {});

} // namespace tss
