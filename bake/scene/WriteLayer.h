#pragma once
#include "bake/scene/Layer.h"

namespace tss {

/// The layer as JSON text, ending with a newline. The same layer always gives the same bytes; reading them
/// gives the same layer. Arrays of numbers fill their lines.
std::string writeJson(const Layer& layer);

/// The same tree as CBOR, the binary twin: half as large, and read faster.
std::string writeCbor(const Layer& layer);

/// A value as JSON on one line.
std::string jsonText(const Value& value);

enum class Encoding { Json, Cbor };

/// Saves a layer: the file is then whole and new, or still what it was. Throws InputError when it cannot be
/// written.
void saveLayer(const Layer& layer, const std::string& file, Encoding encoding = Encoding::Json);

/// The same with the big arrays in a buffer beside the file, which is written first and named by its content:
/// until the scene itself is replaced, the old one still has its own. Old buffers are not removed. Returns
/// the buffer's name, empty when there is no big array.
std::string saveWithBuffer(Layer layer, const std::string& file, Encoding encoding = Encoding::Json);

} // namespace tss
