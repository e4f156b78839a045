#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tss::reporting {

/// The bytes of a PNG file of indices into a palette of at most 256 colours, rows from above; colour 0 is
/// transparent. Throws std::logic_error where width times height is not the number of pixels.
std::string pngOf(const std::vector<std::uint8_t>& pixels, std::uint32_t width, std::uint32_t height,
                  const std::vector<std::array<std::uint8_t, 3>>& palette);

} // namespace tss::reporting
