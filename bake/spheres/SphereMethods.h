#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/TriangleMesh.h"
#include "bake/spheres/Patches.h"
#include "bake/spheres/SphereOptions.h"
#include "bake/spheres/SphereSet.h"

#include <vector>

namespace tss {

// Each way to make spheres of a mesh (METHOD 1).

/// Spheres, each with the radius of the ball about its centre that is inside the solid.
struct MedialSet {
    SphereSet spheres;
    std::vector<double> inner; ///< one per sphere
};

/// Spheres of proven protrusion `protrusion`, or less where a neighbour is near, whose union contains every
/// patch: a greedy choice among the balls of all patches, redundant ones removed (METHOD 1.3).
MedialSet medialSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                        const MedialOptions& options, const Progress& progress = {});

/// The greedy choice among candidates that cover their patches. Stopped, all of them.
MedialSet chooseSpheres(const FittedPatches& fitted, const Progress& progress = {});

/// One ball a patch, slack close to 0 so that it touches the surface at the patch's centre, grown by
/// `protrusion`: plain shrinking balls. Covers the patches when they are fine enough, which fitPatches() sees
/// to.
MedialSet shrinkingSpheres(const Solid& solid, std::span<const Patch> patches, double protrusion,
                           const MedialOptions& options, const Progress& progress = {});

/// The balls inside (METHOD 1.4). Those with nothing left (features thinner than the slack) are points, so
/// that the union still comes as near to every point that was covered as the spheres stick out.
SphereSet inscribed(const MedialSet& set);

/// A sphere of the growth.
struct GrownSphere {
    Sphere sphere;        ///< the last one before a fourth point, T_max or the threshold radius
    std::vector<int> met; ///< the triangle whose centroid is m1 and those met, in this order: 2 to 4
};

/// [paper] Grows the spheres of all triangles in their order (METHOD 1.1), without those that an earlier
/// sphere has met and those that met no second one.
std::vector<GrownSphere> growSpheres(const TriangleMesh& mesh, const GrowthOptions& options,
                                     const Progress& progress = {});

/// [paper] One sphere per vertex, in the order of the vertices (METHOD 1.2). Its radius is half the
/// mean length of the edges there; conservative: at least 1/sqrt(3) of the longest edge of every triangle at
/// the vertex, with which the union contains the surface (every point of a triangle is that near to a
/// corner). Vertices in no triangle have none.
SphereSet surfaceSpheres(const TriangleMesh& mesh, bool conservative);

} // namespace tss
