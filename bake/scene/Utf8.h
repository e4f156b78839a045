#pragma once
#include <string>
#include <string_view>

namespace tss {

/// Bytes of the UTF-8 sequence that begins the text, 0 when there is none (RFC 3629: no overlong forms, no
/// surrogates, nothing above U+10FFFF).
inline std::size_t utf8Length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    if (lead < 0x80) return 1;
    const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < length) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xC0) != 0x80) return 0;
    const unsigned char second = byte(1);
    const bool bad = (lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
                     (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F);
    return bad ? 0 : length;
}

/// The text with each byte that is not UTF-8 replaced by U+FFFD.
inline std::string repairedUtf8(std::string_view text) {
    std::string good;
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        good += length == 0 ? "\xEF\xBF\xBD" : text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return good;
}

/// A string literal of JSON or USD: control characters as escape(byte) writes them, but line feeds as \\n;
/// bytes that are not UTF-8 become U+FFFD, so that the text can always be read.
template <class Escape>
void appendQuoted(std::string& out, std::string_view text, const Escape& escape) {
    out += '"';
    for (const char c : repairedUtf8(text)) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '\n') {
            out += "\\n";
        } else if (byte < 0x20) {
            out += escape(byte);
        } else {
            if (c == '"' || c == '\\') out += '\\';
            out += c;
        }
    }
    out += '"';
}

inline bool isUtf8(std::string_view text) {
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        if (length == 0) return false;
        text.remove_prefix(length);
    }
    return true;
}

/// UTF-8 without zeros; those at its end are of a string that was written with them.
inline bool isText(std::string_view text) {
    return isUtf8(text) && !(text.find('\0') < text.find_last_not_of('\0'));
}

} // namespace tss
