#pragma once
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tss {

/// "1 pair", "2 pairs".
std::string counted(std::size_t count, const std::string& thing);

/// "a, b", and of more than `most` names "a, b and 3 more".
std::string firstOf(const std::vector<std::string>& names, std::size_t most);

std::string lowerCase(std::string word);

/// Letters to put in, take out or change to make one word of another (Levenshtein).
std::size_t editDistance(const std::string& a, const std::string& b);

/// Between double quotes as YAML and gnuplot read them: quotes and backslashes with a backslash before,
/// control characters as blanks.
std::string inQuotes(const std::string& text);

std::string base64(std::string_view bytes);

/// A word as a shell reads it: in quotes where it needs them.
std::string shellWord(const std::string& word);

} // namespace tss
