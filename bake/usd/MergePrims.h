#pragma once
#include "bake/scene/Layer.h"

namespace tss {

/// Puts what a weaker opinion says below what the stronger one does: list ops are joined, dictionaries too,
/// children by their names. Neither has children in a prim of another name.
void mergeUnder(Prim& stronger, Prim weaker);

/// The same for the metadata alone.
void mergeMetadata(Value::Object& stronger, Value::Object weaker);

/// A prim from one path below another one: so are the paths in it that name what is inside.
void movePaths(Prim& prim, const std::string& from, const std::string& to);

} // namespace tss
