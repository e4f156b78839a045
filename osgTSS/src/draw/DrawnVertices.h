#pragma once
#include "bake/base/Lists.h"
#include "bake/geometry/TriangleMesh.h"

#include <osg/Geometry>
#include <osgTSS/SkinGeometry>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace osgTSS {

/// Which vertices of a geometry some primitive draws, and which a triangle.
std::vector<bool> verticesIn(const osg::Geometry& geometry, bool triangles);

/// Which vertices of a geometry stand for each vertex of a mesh: along a seam of texture coordinates or of
/// normals several are at one place, and move as one. Their normals are turned as the mesh's own is since
/// rest. What lines and points draw beside the mesh, as hair, goes with the vertex that it is nearest to.
class DrawnVertices {
public:
    /// scale: from the geometry's lengths to the mesh's (negative: mirrored). restNormals: of the mesh, one a
    /// vertex. Nothing where some vertex of the mesh is not drawn, or the geometry has other vertices than
    /// Vec3Arrays.
    static std::optional<DrawnVertices> of(const osg::Geometry& rest, const tss::TriangleMesh& mesh,
                                           double scale, std::vector<tss::Vec3> restNormals);

    /// Those of one vertex of the mesh; those that stand at its place first.
    std::span<const std::uint32_t> of(std::size_t vertex) const { return _drawn[vertex]; }

    /// Moves what stands for these vertices of the mesh: three spans of one length, in the mesh's lengths.
    void deform(SkinGeometry& shown, std::span<const std::uint32_t> vertices,
                std::span<const tss::Vec3> positions, std::span<const tss::Vec3> normals);
    /// All of them, one per vertex of the mesh.
    void deform(SkinGeometry& shown, std::span<const tss::Vec3> positions,
                std::span<const tss::Vec3> normals);

private:
    double _scale = 1;
    tss::Lists<std::uint32_t> _drawn;                   ///< of each vertex of the mesh
    std::vector<tss::Vec3> _restNormals, _drawnNormals; ///< of the mesh, and one for each of _drawn; the
                                                        ///< latter may be empty
    std::vector<tss::Vec3> _away;                       ///< of each of _drawn from its vertex at rest
    std::vector<std::uint32_t> _all;                    ///< vertices of the mesh
    std::vector<std::uint32_t> _moved;                  ///< room for one call
    std::vector<tss::Vec3> _positions, _normals;
};

} // namespace osgTSS
