#pragma once
#include "bake/scene/Layer.h"

namespace tss {

/// What writeUsda() adds: how a reader knows its layers, and what it keeps as JSON text.
namespace usda {
inline constexpr const char* mark = "osgtss"; ///< in customLayerData: the version of the scene's format
inline constexpr const char* unknownMetadata = "osgtssJson"; ///< in customData: metadata without a word
inline constexpr const char* unknownKeys = "osgtssKeys";     ///< the same of keys of the layer or prim itself
} // namespace usda

/// The layer as .usda, the text form of OpenUSD, which other programs read. Everything that USD has a word
/// for is written with that word. What it has none for, keys and types that are neither USD's nor ours, is
/// kept as JSON text in customData or in an attribute of type string.
std::string writeUsda(const Layer& layer);

} // namespace tss
