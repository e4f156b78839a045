#pragma once
#include "bake/geometry/MeshFile.h"

#include <string>
#include <string_view>

namespace tss {

/// A mesh file on its way from one process of this program to another.
std::string bytesOf(const MeshFile& file);

/// It again. Throws SubprocessFailed for bytes that are cut short.
MeshFile meshFileOf(std::string_view bytes);

} // namespace tss
