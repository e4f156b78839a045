#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <assimp/scene.h>
#include <map>
#include <string>
#include <vector>

namespace tss {

// Parts of readMeshFile(), of builds with OSGTSS_IMPORT.

inline Eigen::Affine3d placeOf(const aiMatrix4x4& m) {
    return Eigen::Affine3d(Eigen::Matrix<ai_real, 4, 4, Eigen::RowMajor>::Map(m[0]).cast<double>().eval());
}

/// Where each node of a file stands in the file's frame, by name; of several the first.
using NodePlaces = std::map<std::string, Eigen::Affine3d>;

/// Where each vertex of a skinned mesh is taken by its bones as these stand in the file, in the file's frame:
/// such a mesh has a frame, a unit and a way up of its own, and its node says nothing of them (glTF 2.0,
/// 3.7.3.1; COLLADA 1.4.1, 4-7). Nothing where its node says the same: the mesh has no bones, these stand as
/// it was bound, or are not all there. ofNode: where the mesh's node stands.
std::vector<Eigen::Affine3d> skinPlaces(const aiMesh& mesh, const NodePlaces& nodes,
                                        const Eigen::Affine3d& ofNode);

/// Puts the vertices of each mesh where its blend shapes take them as far as the file has these on, as
/// viewers show a glTF while nothing is played. Of glTF alone: assimp gives a single shape of FBX the weight
/// 1, whatever its file says.
void applyBlendShapes(aiScene& scene);

} // namespace tss
