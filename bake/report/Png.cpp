#include "bake/report/Png.h"

#include <algorithm>
#include <stdexcept>

namespace tss::reporting {

namespace {

void addBig(std::string& out, std::uint32_t number) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(number >> shift & 255);
}

std::uint32_t crc(const std::string& bytes) {
    std::uint32_t rest = 0xffffffff;
    for (const char c : bytes) {
        rest ^= static_cast<std::uint8_t>(c);
        for (int bit = 0; bit < 8; ++bit) rest = rest >> 1 ^ (rest & 1 ? 0xedb88320u : 0);
    }
    return ~rest;
}

std::uint32_t adler(const std::string& bytes) {
    std::uint32_t a = 1, b = 0;
    for (const char c : bytes) {
        a = (a + static_cast<std::uint8_t>(c)) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

void addChunk(std::string& out, const std::string& type, const std::string& data) {
    addBig(out, static_cast<std::uint32_t>(data.size()));
    out += type + data;
    addBig(out, crc(type + data));
}

/// As zlib has it, in stored blocks.
std::string stored(const std::string& bytes) {
    constexpr std::size_t most = 65535;
    std::string out = "\x78\x01";
    for (std::size_t from = 0; from < bytes.size(); from += most) {
        const std::size_t size = std::min(most, bytes.size() - from);
        out += static_cast<char>(from + size == bytes.size());
        for (const std::size_t number : {size, ~size}) {
            out += static_cast<char>(number & 255);
            out += static_cast<char>(number >> 8 & 255);
        }
        out += bytes.substr(from, size);
    }
    addBig(out, adler(bytes));
    return out;
}

} // namespace

std::string pngOf(const std::vector<std::uint8_t>& pixels, std::uint32_t width, std::uint32_t height,
                  const std::vector<std::array<std::uint8_t, 3>>& palette) {
    if (pixels.size() != std::size_t(width) * height || pixels.empty() || palette.size() > 256)
        throw std::logic_error("a picture needs its pixels and a palette of at most 256 colours");
    std::string header;
    addBig(header, width);
    addBig(header, height);
    header += {8, 3, 0, 0, 0}; // 8 bits, of a palette
    std::string colours, rows;
    for (const auto& colour : palette)
        for (const std::uint8_t channel : colour) colours += static_cast<char>(channel);
    for (std::uint32_t y = 0; y < height; ++y) {
        rows += '\0'; // no filter
        rows.append(reinterpret_cast<const char*>(&pixels[std::size_t(y) * width]), width);
    }
    std::string out = "\x89PNG\r\n\x1a\n";
    addChunk(out, "IHDR", header);
    addChunk(out, "PLTE", colours);
    addChunk(out, "tRNS", std::string(1, '\0'));
    addChunk(out, "IDAT", stored(rows));
    addChunk(out, "IEND", "");
    return out;
}

} // namespace tss::reporting
