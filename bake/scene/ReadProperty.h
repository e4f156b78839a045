#pragma once
#include "bake/scene/Layer.h"
#include "bake/scene/Problems.h"

namespace tss {

/// An attribute or a relationship from its JSON object; its value is checked against its typeName.
Property readProperty(Value object, const Place& place, Problems& problems);

/// Checks an array of strings or a list op of such: {"prepend": [...], "append": ..., "delete": ...,
/// "explicit": ...}. wanted: what the strings are, for the message.
void checkList(const Value& value, const Place& place, const std::string& wanted, Problems& problems);

/// Checks that the strings of such a list are absolute paths of prims or properties.
void checkPaths(const Value& value, const Place& place, Problems& problems);

/// Words [A-Za-z_][A-Za-z0-9_]* with colons between.
bool isPropertyName(std::string_view name);

} // namespace tss
