#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/MeshQuery.h"
#include "bake/geometry/TriangleMesh.h"
#include "bake/motion/Motion.h"
#include "bake/motion/MotionBound.h"

#include <cstdint>
#include <optional>

namespace tss {

/// A proof, from the triangles alone, that two surfaces never meet.
struct SurfacesApart {
    double clearance = 0;    ///< they stay farther apart than this at every pose of Q, scene units, > 0
    std::uint64_t cells = 0; ///< of Q that the proof took
};

/// Branch and bound over Q: a cell is done where the surfaces stay farther apart than the clearance in it
/// (METHOD 2.3). The clearance shown is 7/8 of the least distance seen where few cells are expected to be
/// needed, else half of it; where that is not shown, 7/8 of how far the surfaces stay apart along the axis of
/// a turn (apartAlongAxis()). Nothing where they come nearer to each other than `touching`, scene units (see
/// touchingDistance()), and where it would take too long: for most pairs spheres are quicker, for parts that
/// stand close all over the motion they would have to be very small. The same for any number of threads.
/// nearest: where given, becomes the least distance that was seen at any pose.
std::optional<SurfacesApart> surfacesApart(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion,
                                           double touching, const Progress& progress = {},
                                           double* nearest = nullptr);

/// How far apart the two stay along the axis of one of their turns at least, at every pose of Q, scene units;
/// 0 or less: they may overlap along it. The links of a flat linkage turn about parallel axes and never leave
/// their layers, however many they are and however close the layers lie.
double apartAlongAxis(const TriangleMesh& a, const TriangleMesh& b, const Motion& motion);

/// Whether all pairs of triangles of A and B are shown to stay farther apart than `distance` all over the
/// cell, each by a separating axis: B's corners move along it by no more than their first derivative there
/// times the cell's half widths and a bound of the second order. Motion across the axis does not count, so
/// that surfaces may slide past each other closely. rounding: see coordinateRounding(). looked: raised by the
/// pairs of nodes and of triangles looked at; beyond `most` it gives up and returns false.
bool trianglesApart(const MeshQuery& a, const MeshQuery& b, const CellMotion& motion, double distance,
                    double rounding, std::uint64_t most, std::uint64_t& looked);

} // namespace tss
