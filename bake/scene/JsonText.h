#pragma once
#include "bake/scene/Value.h"

#include <string_view>

namespace tss {

/// Appends a JSON string literal. Bytes that are not UTF-8 are written as U+FFFD, so that the text can always
/// be read.
void appendQuoted(std::string& out, std::string_view text);

/// A value as JSON on one line.
std::string jsonText(const Value& value);

/// The whole text is UTF-8.
bool isUtf8(std::string_view text);

/// The text with each byte that is not UTF-8 replaced by U+FFFD.
std::string repairedUtf8(std::string_view text);

} // namespace tss
