#pragma once
#include "bake/geometry/Import.h"
#include "bake/geometry/MeshFile.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct aiScene;

namespace tss {

// What readMeshFile() is made of.

/// A glTF file, text or binary, as assimp reads it.
struct PlainGltf {
    std::string bytes;
    std::vector<std::string> leftOut; ///< in a few words each
};

/// The file with skins that assimp can read: it crashes on one without inverse bind matrices, as glTF lets
/// them be, finds joints by names alone, and gives a skin to a mesh, where glTF gives it to a node. Nothing where it is no glTF 2 that can be read as JSON: what it is then the importer says. Throws
/// InputError for nodes that are more than 1000 levels deep, for positions that are no floats, and where the
/// file needs an extension that is not read and may change surfaces.
std::optional<PlainGltf> plainGltf(const std::string& file);

/// What a file says of itself beside its meshes, the unit and the axes that they are read with: of Collada,
/// which assimp turns into metres, glTF, FBX, 3MF and AMF. And what no reader tells of: the parts of a 3MF in
/// other files of its archive, and how coarse the floats are that it is held in.
MeshFileNotes statedNotes(const std::string& file, const aiScene& scene);

/// A mesh file on its way from one process of this program to another.
std::string bytesOf(const MeshFile& file);

/// It again. Throws SubprocessFailed for bytes that are cut short.
MeshFile meshFileOf(std::string_view bytes);

} // namespace tss
