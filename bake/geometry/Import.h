#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <string>
#include <vector>

namespace tss {

/// Which way is up in a file that says so itself: turned to how its reader likes it (for Collada, Y up), or
/// as its numbers stand there, the convention of robots' files.
enum class MeshAxes { Turned, AsWritten };

/// Reads every mesh of a file that assimp reads as one: node transforms applied, polygons triangulated,
/// vertices at exactly the same place made one (in the order of their first use), points and lines left out.
/// Nothing else is repaired: see auditMesh() and cleaned(). assimp holds coordinates as floats, so that at
/// most 7 digits of a file survive: a mesh far from the origin of its file loses detail (at 1e7 units a float
/// is 1 unit wide). Other files that it names are read where they lie in its folder or below. Throws
/// InputError: no such file, a format or content that cannot be read, no triangle in it, a corner that is not
/// finite, a face of more than 10,000 corners, or a build without OSGTSS_IMPORT.
/// leftOut, where given, receives what else the file holds and a mesh has no place for: animations, bones,
/// shapes to blend to, cameras, lights, points and lines.
TriangleMesh importMesh(const std::string& file, MeshAxes axes = MeshAxes::Turned,
                        std::vector<std::string>* leftOut = nullptr);

/// One node of a file with the meshes that hang on it.
struct ImportedNode {
    std::string name;
    Eigen::Affine3d place = Eigen::Affine3d::Identity(); ///< in the file's own frame
    TriangleMesh mesh;                                   ///< in the node's
};

/// The same with each node that has meshes for itself. Throws as importMesh() does.
std::vector<ImportedNode> importNodes(const std::string& file, std::vector<std::string>* leftOut = nullptr);

/// The file is a glTF, whose Y axis is up and whose unit is the metre, always.
bool isGltf(const std::string& file);

/// The mesh with vertices at exactly the same place made one, in the order of their first appearance.
TriangleMesh welded(const TriangleMesh& mesh);

} // namespace tss
