#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"
#include "bake/motion/MotionBound.h"

#include <cstdint>
#include <optional>

namespace tss {

/// That two surfaces never meet, shown without a single sphere.
struct SurfacesApart {
    double clearance = 0;    ///< they stay farther apart than this at every pose of Q, scene units, > 0
    std::uint64_t cells = 0; ///< of Q that showed it
};

/// Branch and bound over Q: a cell is settled where any two triangles stay farther apart than the clearance
/// in it (METHOD 2.3). That is half of the least distance, or 7/8 of it where this is soon shown; where it is
/// not, 7/8 of how far they stay apart along the axis of a turn, if they do (apartAlongAxis()). Nothing
/// where they come nearer than `touching` to each other, and where it would take so long that other ways are
/// quicker: this is for joints whose parts stand close all the way round, which would take very fine spheres.
/// touching: see touchingDistance(). The same for any number of threads.
std::optional<SurfacesApart> surfacesApart(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                                           double touching, const Progress& progress = {});

/// How far apart the two stay along the axis of one of their turns at least, at every pose of Q, scene units;
/// 0 or less: they may overlap along it. The links of a flat linkage turn about parallel axes and never leave
/// their layers, however many they are and however close the layers lie.
double apartAlongAxis(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion);

/// Whether any two triangles of A and B stay farther apart than `distance` all over the cell. Two are told
/// apart along one direction: B's corners move along it by no more than the slope there says and what second
/// order adds, so that surfaces which slide past each other may be as near as they like. false: not shown.
/// rounding: see coordinateRounding(). looked: counts pairs of nodes and triangles; beyond `most` it gives
/// up.
bool trianglesApart(const MeshQuery& a, const MeshQuery& b, const CellMotion& motion, double distance,
                    double rounding, std::uint64_t most, std::uint64_t& looked);

} // namespace tss
