#pragma once
#include "bake/scene/Layer.h"

namespace tss {

struct UsdVariantSet;

/// What one layer says of one prim: a prim without children, and what composition makes of it.
/// In metadata, list ops: references and payload, each item "@FILE@", "@FILE@</Prim>" or "/Prim" with FILE
/// relative to the folder of the first layer; inheritPaths, specializes. variantSelection: set to variant.
struct UsdSpec {
    Prim prim;
    std::vector<UsdSpec> children;
    std::vector<UsdVariantSet> variantSets;
    std::size_t line = 0;
};

/// A set of alternatives of a prim: what each says of the prim and of what is below it.
struct UsdVariantSet {
    std::string name;
    std::vector<UsdSpec> variants; ///< by prim.name
};

/// One file as it stands there.
struct UsdLayer {
    std::string file;                   ///< its name for messages
    Value::Object metadata;             ///< without subLayers
    std::vector<std::string> subLayers; ///< FILE as above, the strongest first
    std::vector<UsdSpec> children;
    std::vector<std::string> notes; ///< what was left out, by name
};

} // namespace tss
