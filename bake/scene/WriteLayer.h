#pragma once
#include "bake/scene/Layer.h"

namespace tss {

/// The layer as JSON text, ending with a newline. The same layer always gives the same bytes; reading them
/// gives the same layer. Arrays of numbers fill their lines.
std::string writeJson(const Layer& layer);

/// The same tree as CBOR, the binary twin: a quarter smaller, and read several times faster.
std::string writeCbor(const Layer& layer);

enum class Encoding { Json, Cbor };

/// Saves a layer: the file is then whole and new, or still what it was. Throws InputError when it cannot be
/// written.
void saveLayer(const Layer& layer, const std::string& file, Encoding encoding = Encoding::Json);

} // namespace tss
