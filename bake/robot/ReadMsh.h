#pragma once
#include "bake/geometry/TriangleMesh.h"

#include <string>

namespace tss {

/// The name of a mesh in MuJoCo's own binary form.
bool isMsh(const std::string& file);

/// Reads MuJoCo's MSH (its documentation, "XML Reference", asset/mesh): four int32 (vertices, normals,
/// texture coordinates, faces), float32 positions, normals and texture coordinates, int32 corners; little
/// endian. Vertices at one place are made one. Throws InputError for bytes that are not of that length, a
/// corner that names no vertex, a coordinate that is not finite, or no face.
TriangleMesh readMsh(const std::string& bytes, const std::string& file);

} // namespace tss
