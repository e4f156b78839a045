#pragma once
#include "bake/scene/Layer.h"

#include <functional>
#include <optional>

namespace tss {

/// Puts what a weaker opinion says below what the stronger one does: list ops are joined, dictionaries too,
/// children by their names. Neither has children in a prim of another name.
void mergeUnder(Prim& stronger, Prim weaker);

/// The same for the metadata alone.
void mergeMetadata(Value::Object& stronger, Value::Object weaker);

/// A path as it is called elsewhere; none: nowhere.
using MapPath = std::function<std::optional<std::string>(const std::string& path)>;

/// The paths that a prim's relationships and connections name, as they are called elsewhere; those that are
/// nowhere there are left away.
void mapPaths(Prim& prim, const MapPath& map);

} // namespace tss
