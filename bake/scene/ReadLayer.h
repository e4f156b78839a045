#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"

#include <string_view>

namespace tss {

/// Reads a scene from JSON text, or from CBOR, told apart by its first bytes. Checks everything that can be
/// checked without knowing what a prim means: JSON, the shape of prims and properties, each value against its
/// typeName. Arrays in buffers are read from beside the file of this name. Throws InputError at the first
/// thing wrong, with file, JSON pointer, path and what was expected.
Layer parseLayer(std::string_view text, const std::string& fileName);

/// The same into `problems`, which may collect; what cannot be read is left out of the layer.
Layer parseLayer(std::string_view text, const std::string& fileName, Problems& problems);

/// Reads a scene file. Throws InputError, also when the file cannot be opened.
Layer readLayer(const std::string& file);

/// The tree as parsed, as a layer. Takes the big arrays out of `root`.
Layer layerFromValue(Value root, Problems& problems);

} // namespace tss
