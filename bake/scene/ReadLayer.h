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

/// An attribute or a relationship from its JSON object; its value is checked against its typeName.
Property readProperty(Value object, const Place& place, Problems& problems);

/// Words [A-Za-z_][A-Za-z0-9_]* with colons between.
bool isPropertyName(std::string_view name);

} // namespace tss
