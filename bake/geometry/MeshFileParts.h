#pragma once
#include "bake/geometry/Import.h"
#include "bake/geometry/RigFile.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct aiScene;

namespace tss {

/// A mesh file as it stands there: polygons cut into triangles, nothing welded, nothing checked.
struct MeshFile {
    std::vector<ImportedNode> nodes; ///< those that have faces, each before what hangs on it
    MeshFileNotes notes;
};

/// Reads it through assimp, in a process of its own: some readers crash on a file, take all memory for it, or
/// print. Throws InputError, for such a file too.
MeshFile readMeshFile(const std::string& file);

// What readMeshFile() is made of.

/// Throws InputError for a binary glTF whose chunks say that they are longer than the file is, which an
/// importer would make room for.
void expectWholeGlb(const std::string& file);

/// A glTF file, text or binary, as assimp reads it.
struct PlainGltf {
    std::string bytes;
    std::vector<std::string> leftOut; ///< in a few words each
};

/// The file with skins that assimp can read: it crashes on one without inverse bind matrices, which glTF
/// allows, finds joints by names alone, and gives a skin and the weights of blend shapes to a mesh, where
/// glTF gives them to a node. Nothing where the file is not a glTF 2 with readable JSON: the importer then
/// says what is wrong. Throws InputError for nodes that are more than 1000 levels deep, for positions that
/// are not floats, and for a required extension that is not read and may change surfaces.
std::optional<PlainGltf> plainGltf(const std::string& file);

/// A PLY with faces in place of its triangle strips, of each of which assimp reads the last triangle alone.
/// Throws InputError for one with faces too, and for strips that cannot be read.
std::string plainPly(const std::string& file);

/// The unit and the up axis that a file of Collada (which assimp turns into metres), glTF, FBX, 3MF or AMF
/// states, and two things that assimp does not report: parts of a 3MF that lie in other files of its archive,
/// and the spacing of floats at the mesh's coordinates where it is too coarse.
MeshFileNotes statedNotes(const std::string& file, const aiScene& scene);

/// Serializes a mesh file, to hand it from one process of this program to another.
std::string bytesOf(const MeshFile& file);

std::string bytesOf(const RigFile& file);

/// The inverses of bytesOf(). Throw SubprocessFailed for bytes that are cut short.
MeshFile meshFileOf(std::string_view bytes);
RigFile rigFileOf(std::string_view bytes);

} // namespace tss
