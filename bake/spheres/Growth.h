#pragma once
#include "bake/base/Progress.h"
#include "bake/geometry/TriangleMesh.h"
#include "bake/spheres/SphereOptions.h"
#include "bake/spheres/SphereSet.h"

#include <vector>

namespace tss {

/// One stage of the growth of a sphere (the paper's Figure 1f-i): the ball grew along the line from `anchor`
/// in `direction` until it met the centroid of triangle `met`.
struct GrowthStage {
    Vec3 anchor;    ///< m1; then m_L, the middle of m1 and m2; then m_T, the middle of m1, m2 and m3
    Vec3 direction; ///< unit length; -N first, then from the anchor to the centre so far
    double t = 0;   ///< T at the end of the stage: centre = anchor + t * direction
    Vec3 centre;
    double radius = 0; ///< distance of the centre from m1, m2 and m3, the largest of those met so far
    int met = -1;      ///< the triangle whose centroid ended the stage; -1: T_max or the threshold radius did
};

/// How one sphere grew.
struct GrowthTrace {
    int seed = -1;                   ///< the triangle whose centroid is m1
    std::vector<GrowthStage> stages; ///< 1 to 3
    Sphere sphere;                   ///< the last one before a fourth point, T_max or the threshold radius
    bool bounded = false;            ///< at least a second point was met
    std::vector<int> met;            ///< the seed and the triangles met, in this order
};

/// [paper] Grows the sphere of one triangle (METHOD 1.1). All triangles of the mesh have an area.
GrowthTrace growSphere(const TriangleMesh& mesh, int triangle, const GrowthOptions& options);

/// [paper] Grows the spheres of all triangles in their order, without those that an earlier sphere has met
/// and those that nothing bounded, unless the options ask for them.
std::vector<GrowthTrace> growSpheres(const TriangleMesh& mesh, const GrowthOptions& options,
                                     const Progress& progress = {});

} // namespace tss
