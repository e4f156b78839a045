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

/// About what a prim, or a spec with all below it, takes in memory, in bytes.
std::size_t costOf(const Prim& prim);
std::size_t costOf(const UsdSpec& spec);

/// The items of a list op in the prim's metadata, the strongest first.
std::vector<std::string> arcsOf(const Prim& prim, const char* key);

/// One stack of layers as one: those of the weaker first, as USD has them.
void mergeSpecs(std::vector<UsdSpec>& stronger, std::vector<UsdSpec> weaker);

/// Whether a prim, or one below it, has more to it than one layer says: variants, arcs, other files.
bool needsComposition(const UsdSpec& spec);

/// One file as it stands there.
struct UsdLayer {
    std::string file;                   ///< its name for messages
    Value::Object metadata;             ///< without subLayers
    std::vector<std::string> subLayers; ///< FILE as above, the strongest first
    std::vector<UsdSpec> children;
    std::vector<std::string> notes; ///< what was left out, by name
};

} // namespace tss
