#pragma once
#include "bake/scene/LocatedError.h"

#include <string_view>
#include <vector>

namespace tss {

/// Line and column of a byte of a text.
TextPosition positionOf(std::string_view text, std::size_t offset);

/// Where the values that JSON pointers name stand in a text, one position a pointer: that of the nearest
/// value around it where there is none (a key that is missing), of the later one where a key stands twice.
/// Reads the text once, up to where it stops being JSON.
std::vector<TextPosition> locateJson(std::string_view text, const std::vector<std::string>& pointers);

} // namespace tss
