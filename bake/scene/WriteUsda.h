#pragma once
#include "bake/scene/Layer.h"

namespace tss {

/// The layer as .usda, the text form of OpenUSD, which other programs read. Everything that USD has a word
/// for is written with that word. What it has none for, keys and types that are neither USD's nor ours, is
/// kept as JSON text in customData or in an attribute of type string.
std::string writeUsda(const Layer& layer);

} // namespace tss
