#pragma once
#include "bake/usd/UsdSpec.h"

#include <functional>

namespace tss {

/// A layer that another one names: the text, and one name for one file.
struct UsdFile {
    std::string file, text;
};

/// Opens the file of this name relative to the folder of the first layer. Throws InputError that names it.
using OpenUsd = std::function<UsdFile(const std::string& name)>;

/// The file beside the first layer, or in a folder below its own, also through links; others are refused.
OpenUsd besideUsd(const std::string& file);

/// A stage: one layer, composed of all that its first one names.
struct UsdStage {
    Layer layer;
    std::vector<std::string> notes; ///< what was left out, by name
    bool ours = false;              ///< a scene of this software: written by it, or with Tss schemas
};

/// Reads a stage from the text of its first layer. Where that one names no other file, and itself by
/// references alone, it is kept as it stands; a layer that this software wrote is then the same again. Else
/// sublayers, inherits, the variants that are selected, references, payloads and specializes are composed in
/// USD's order of strength, and none of them is left in the layer. A class that a stronger layer overrides
/// for a weaker one's inherits is not found there. Throws InputError: as parseUsda(), a prim, a variant or a
/// file that is not there, what leads back to itself, more than 64 arcs in each other, and what makes more
/// than 65536 prims or 16777216 numbers.
UsdStage readStage(const std::string& text, const std::string& file, const OpenUsd& open);

} // namespace tss
