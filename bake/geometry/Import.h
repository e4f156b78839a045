#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <string>
#include <vector>

namespace tss {

/// What a file says beside its meshes.
struct MeshFileNotes {
    std::vector<std::string> leftOut; ///< that it holds too, in a few words each: "2 cameras"
    double metersPerUnit = 0;         ///< of the mesh as it is read; 0: the file does not say
    char upAxis = '\0';               ///< 'Y' or 'Z'; 0: the file does not say
    double step = 0; ///< units between coordinates where the mesh lies so far out that floats are too coarse
                     ///< for it; 0: they are fine
};

/// Reads every mesh of a file that assimp reads as one: node transforms applied, polygons triangulated,
/// vertices at exactly the same place made one (in the order of their first use), points and lines left out.
/// A skinned mesh stands where its bones in the file take it, as nothing else says how large it is and which
/// of its ways is up. Nothing is turned: whatever way is up in the file, the numbers stay (Collada's in
/// metres). Nothing else is repaired: see auditMesh() and cleaned(). assimp holds coordinates as floats, so
/// that at most 7 digits of a file survive: a mesh far from the origin of its file loses detail (at 1e7 units
/// a float is 1 unit wide). Other files that it names are read where they lie in its folder or below. Throws
/// InputError: no such file, a format or content that cannot be read, also where its reader crashes or takes
/// all memory, no triangle in it, a corner that is not finite or not there, a face of more than 10,000
/// corners, or a build without OSGTSS_IMPORT. notes, where given, receives what else the file says and holds:
/// animations, bones, shapes to blend to, cameras, lights, points and lines are left out.
TriangleMesh importMesh(const std::string& file, MeshFileNotes* notes = nullptr);

/// One node of a file with the meshes that hang on it.
struct ImportedNode {
    std::string name;
    Eigen::Affine3d place = Eigen::Affine3d::Identity(); ///< in the file's own frame
    TriangleMesh mesh;                                   ///< in the node's
};

/// The same, but each node that has meshes stays a mesh of its own. Throws as importMesh() does.
std::vector<ImportedNode> importNodes(const std::string& file, MeshFileNotes* notes = nullptr);

/// The notes as sentences, and a warning where metersPerUnit is not the unit that the file states.
std::vector<std::string> remarks(const std::string& file, const MeshFileNotes& notes, double metersPerUnit);

/// The file is a glTF, or an avatar as one (VRM), whose Y axis is up and whose unit is the metre, always.
bool isGltf(const std::string& file);

/// ".obj" of "A.OBJ"
std::string extensionOf(const std::string& file);

/// The mesh with vertices at exactly the same place made one, in the order of their first appearance.
TriangleMesh welded(const TriangleMesh& mesh);

} // namespace tss
