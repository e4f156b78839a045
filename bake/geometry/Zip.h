#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tss {

/// The files of a ZIP archive whose names end so, each with its content, in the archive's order; those of
/// which the archive is broken, or which are packed by another method than deflate, are not among them.
std::vector<std::pair<std::string, std::string>> unzipped(std::string_view archive, std::string_view ending);

} // namespace tss
