#pragma once
#include "bake/scene/Value.h"
#include "bake/usd/UsdaCursor.h"

namespace tss {

/// Levels of prims, tuples, arrays and dictionaries in each other.
inline constexpr int deepestUsda = 64;

/// Any value as it stands there: numbers, tuples and arrays of them as Numbers where they are all alike;
/// texts, assets and paths as text; None as null; dictionaries as objects.
Value parseUsdaValue(UsdaCursor& cursor, int level);

/// The same for a slot of this type, whose values it is checked against: 0 and 1 are what a bool may be
/// written as. A type that USD does not have is kept as it stands there.
Value parseUsdaValue(UsdaCursor& cursor, const std::string& typeName, int level);

/// A type as it is called today; old layers have other names for some.
std::string todaysUsdType(const std::string& type);

/// What stands between { and }.
Value::Object parseUsdaDictionary(UsdaCursor& cursor, int level);

} // namespace tss
