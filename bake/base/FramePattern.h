#pragma once
#include <cstdio>
#include <string>
#include <vector>

namespace tss {

/// A file name with one conversion of a whole number in it, as printf has it: f_%04d.png.
inline bool isFramePattern(const std::string& pattern) {
    const std::size_t percent = pattern.find('%');
    if (percent == std::string::npos || pattern.find('%', percent + 1) != std::string::npos) return false;
    const std::size_t letter = pattern.find_first_not_of("0123456789", percent + 1);
    return letter != std::string::npos && (pattern[letter] == 'd' || pattern[letter] == 'u') &&
           letter - percent <= 3;
}

/// The name of a frame. The pattern must be one.
inline std::string frameName(const std::string& pattern, unsigned int frame) {
    std::vector<char> name(pattern.size() + 128);
    std::snprintf(name.data(), name.size(), pattern.c_str(), frame);
    return name.data();
}

} // namespace tss
