#pragma once
#include <cstddef>
#include <string>

namespace tss {

/// "1 pair", "2 pairs".
std::string counted(std::size_t count, const std::string& thing);

/// Between double quotes as YAML and gnuplot read them: quotes and backslashes with a backslash before,
/// control characters as blanks.
std::string inQuotes(const std::string& text);

/// A word as a shell reads it: in quotes where it needs them.
std::string shellWord(const std::string& word);

} // namespace tss
