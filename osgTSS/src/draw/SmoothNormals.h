#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <cstdint>
#include <vector>

namespace osgTSS {

/// A mesh as it is drawn: vertices split where the surface has a crease, one normal each.
struct ShadedMesh {
    std::vector<std::uint32_t> source; ///< of each drawn vertex, its vertex in the mesh
    std::vector<tss::Vec3> normals;    ///< unit, one a drawn vertex
    std::vector<tss::Tri> triangles;   ///< indices of drawn vertices; triangles without area are left out
};

/// Normals weighted by the corner angles, averaged over the triangles around a vertex that hang together over
/// edges flatter than the crease angle (radians). Vertices in one place count as one, so that meshes stored
/// as loose triangles come out smooth too.
ShadedMesh shade(const tss::TriangleMesh& mesh, double creaseAngle);

} // namespace osgTSS
