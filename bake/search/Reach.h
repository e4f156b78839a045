#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/search/UndecidedCells.h"
#include "bake/spheres/Patches.h"

namespace tss {

/// Which of two bodies a surface belongs to: A stands, B moves.
enum class Side { A, B };

/// The parts of the surface of one body that come within `margin` of the other's mesh at some pose of a part
/// of Q (METHOD 1.4). Sound: what is left out stays farther away at every one of those poses; what is kept
/// may stay a few `size` away. Patches larger than `size` are halved. patches: of the body on `side`, in its
/// own frame. other: the mesh of the other body, in its own frame. size: radius of the patches to end with,
/// scene units, > 0. The same for any number of threads.
std::vector<Patch> findReach(std::span<const Patch> patches, Side side, const MeshQuery& other,
                             const Motion& motion, const CellTree& cells, double size, double margin,
                             const Progress& progress = {});

} // namespace tss
