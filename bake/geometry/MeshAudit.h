#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tss {

/// What is wrong or unusual with a mesh. Counts; an edge is a pair of vertices that some triangle joins.
struct MeshAudit {
    int vertices = 0;
    int triangles = 0;
    int openEdges = 0;           ///< edges of one triangle only
    int nonManifoldEdges = 0;    ///< edges of more than two triangles
    int misorientedEdges = 0;    ///< edges of two triangles that run through them in the same direction
    int zeroAreaTriangles = 0;   ///< a corner twice, or corners in a line up to rounding
    int duplicateTriangles = 0;  ///< same corners in the same turning sense as an earlier one
    int turnedOverTriangles = 0; ///< pairs of the same corners in opposite senses, which bound nothing
    int unusedVertices = 0;
    int duplicateVertices = 0; ///< at exactly the place of an earlier vertex
    int notFinite = 0;         ///< vertices with a NaN or infinite coordinate
    int badIndices = 0;        ///< triangles with an index outside [0, #V)
    int components = 0;        ///< sets of triangles joined by vertices
    double signedVolume = 0;   ///< scene units cubed; of the closed mesh; negative where it is inside out
    bool watertight = false;   ///< every edge has two triangles, run through in opposite directions

    /// It can be used as it is or after cleaned(): finite, indices in range, a triangle with an area.
    bool usable() const { return notFinite == 0 && badIndices == 0 && triangles > zeroAreaTriangles; }
    bool insideOut() const { return watertight && signedVolume < 0; }
};

/// Counts everything; never throws for a bad mesh.
MeshAudit auditMesh(const TriangleMesh& mesh);

/// A few lines for people: size first, then what is wrong, nothing of what is right.
std::string text(const MeshAudit& audit);

/// The triangle has no area: a corner twice, or its height is under 1e-14 of its longest edge.
bool hasZeroArea(const Vec3& a, const Vec3& b, const Vec3& c);
bool hasZeroArea(const TriangleMesh& mesh, std::size_t triangle);

/// Throws InputError for vertices that are not finite and for indices out of range; an empty mesh passes.
void checkIndices(const TriangleMesh& mesh);

/// The mesh without duplicate triangles and without unused vertices, and without those zero-area triangles
/// that lie on its other triangles: each of their edges, but for rounding, on one of those. All else stays,
/// order included; a zero-area triangle that stays is a segment or a point of surface. Throws InputError for
/// what cannot be used: vertices that are not finite, indices out of range, no triangle with an area. loaded,
/// where given, says of each triangle kept its index in the mesh handed over.
TriangleMesh cleaned(const TriangleMesh& mesh, std::vector<std::uint32_t>* loaded = nullptr);

} // namespace tss
