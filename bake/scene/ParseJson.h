#pragma once
#include "bake/scene/Value.h"

#include <string_view>

namespace tss {

/// Reads one JSON text, UTF-8. Throws LocatedError, with JSON pointer, line and column, for anything that is
/// not strictly JSON (comments, trailing text, a byte order mark, not-finite numbers), and for what JSON
/// allows but a scene file does not: a key twice in one object, more than 64 levels, a NUL byte.
Value parseJson(std::string_view text, const std::string& fileName);

} // namespace tss
