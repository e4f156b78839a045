#pragma once
#include "bake/geometry/Import.h"

#include <string>
#include <vector>

namespace tss {

/// A mesh file as it stands there: polygons cut into triangles, nothing welded, nothing checked.
struct MeshFile {
    std::vector<ImportedNode> nodes; ///< those that have faces, each before what hangs on it
    MeshFileNotes notes;
};

/// Reads it through assimp, in a process of its own: some readers crash on a file, take all memory for it, or
/// print. Throws InputError, for such a file too.
MeshFile readMeshFile(const std::string& file);

} // namespace tss
