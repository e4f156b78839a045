#pragma once
#include "bake/geometry/Import.h"

struct aiScene;

namespace tss {

/// What a file says of itself beside its meshes, the unit and the axes that they are read with: of Collada,
/// which assimp turns into metres, glTF, FBX, 3MF and AMF. And what no reader tells of: the parts of a 3MF in
/// other files of its archive, and how coarse the floats are that it is held in.
MeshFileNotes statedNotes(const std::string& file, const aiScene& scene);

} // namespace tss
