#pragma once
#include "bake/usd/UsdSpec.h"
#include "bake/usd/UsdaCursor.h"

namespace tss {

/// What is wrong with a file that is no text of USD: a binary layer, a package, another format; else empty.
/// first: the file of the stage's first layer.
std::string notUsda(std::string_view text, const std::string& first);

/// Reads one layer from USD's text form. Everything of it is kept, but for what has no value (the order of
/// children and properties) and what is noted. folder: of the file, relative to that of the first layer,
/// which the files that it names become relative to. Throws InputError with file, line and prim: what is no
/// USD text, values that are none of their type, more than 64 levels, what would take too much memory, and
/// relocates.
UsdLayer parseUsda(std::string_view text, const std::string& file, const std::string& folder,
                   UsdBudget& budget);

} // namespace tss
