#pragma once
#include "bake/scene/ValueType.h"

namespace tss {

/// Appends a value of this type as .usda writes it: tuples in (), arrays in [], text in quotes, None for
/// null.
void appendUsda(std::string& out, const Value& value, const ValueType& type);

/// Appends a string literal: \ and quotes escaped, line breaks as \n.
void appendUsdaString(std::string& out, std::string_view text);

/// Appends `{ ... }` with the type of each entry that its value suggests; values that no USD type fits as
/// JSON text.
void appendUsdaDictionary(std::string& out, const Value::Object& object, std::size_t indent);

} // namespace tss
