#pragma once
#include "bake/geometry/Import.h"

#include <string>
#include <utility>
#include <vector>

namespace tss {

/// A mesh file with what moves its meshes: the tree of its nodes, animations of these, and weights of bones.
struct RigFile {
    struct Node {
        std::string name;
        int parent = -1;       ///< a node before it; -1: the root
        Eigen::Affine3d local; ///< in its parent, while nothing is played
    };
    /// What an animation makes of a node in its parent: a place, a turn and a scale, each at times of its
    /// own, linear between them; none: no place, no turn, the scale 1.
    struct Channel {
        int node = -1;
        std::vector<double> placeTimes, turnTimes, scaleTimes; ///< seconds, rising
        std::vector<Eigen::Vector3d> places, scales;
        std::vector<Eigen::Vector4d> turns; ///< x, y, z, w
    };
    struct Animation {
        std::string name;
        std::vector<Channel> channels;
    };
    struct Mesh {
        int node = -1;        ///< that it hangs on
        TriangleMesh surface; ///< in its own frame; nothing welded, each vertex of the file
        std::vector<std::pair<int, Eigen::Affine3d>>
            bones; ///< nodes, and from the mesh to them as it is bound
        std::vector<std::vector<std::pair<int, double>>>
            weights; ///< #V, of bones; none of a mesh without any
    };
    std::vector<Node> nodes; ///< parents first
    std::vector<Animation> animations;
    std::vector<Mesh> meshes; ///< that have faces
    MeshFileNotes notes;      ///< of the rest
};

/// Reads it through assimp, in a process of its own. Throws InputError as importMesh() does, but for a file
/// without any triangle.
RigFile readRigFile(const std::string& file);

/// The file is of a format that holds bones or animations, by its name.
bool isRigName(const std::string& file);

} // namespace tss
