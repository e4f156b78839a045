#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <string>

namespace tss {

/// Which way is up in a file that says so itself: turned to how its reader likes it (for Collada, Y up), or
/// as its numbers stand there, the convention of robots' files.
enum class MeshAxes { Turned, AsWritten };

/// Reads every mesh of a file that assimp reads as one: node transforms applied, polygons triangulated,
/// vertices at exactly the same place made one (in the order of their first use), points and lines left out.
/// Nothing else is repaired: see auditMesh() and cleaned(). assimp holds coordinates as floats, so that at
/// most 7 digits of a file survive: a mesh far from the origin of its file loses detail (at 1e7 units a float
/// is 1 unit wide). Throws InputError: no such file, a format or content that cannot be read, no triangle in
/// it, or a build without OSGTSS_IMPORT.
TriangleMesh importMesh(const std::string& file, MeshAxes axes = MeshAxes::Turned);

/// The mesh with vertices at exactly the same place made one, in the order of their first appearance.
TriangleMesh welded(const TriangleMesh& mesh);

} // namespace tss
