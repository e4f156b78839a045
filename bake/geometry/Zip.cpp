// PKWARE's APPNOTE.TXT, 4.3: the directory at the end of a ZIP archive, and the headers that it leads to.
#include "bake/geometry/Zip.h"

#ifdef OSGTSS_IMPORT

#include <cstddef>
#include <optional>
#include <zlib.h>

namespace tss {

namespace {

/// Little-endian; nothing beyond the end.
std::optional<std::size_t> number(std::string_view bytes, std::size_t at, std::size_t size) {
    if (at > bytes.size() || size > bytes.size() - at) return std::nullopt;
    std::size_t value = 0;
    for (std::size_t k = size; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
    return value;
}

std::size_t two(std::string_view bytes, std::size_t at) {
    return number(bytes, at, 2).value_or(0);
}
std::size_t four(std::string_view bytes, std::size_t at) {
    return number(bytes, at, 4).value_or(0);
}

std::optional<std::string> inflated(std::string_view packed) {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return std::nullopt; // without a header of zlib's own
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    std::string text;
    char some[1 << 16];
    int state = Z_OK;
    while (state == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(some);
        stream.avail_out = sizeof some;
        state = inflate(&stream, Z_NO_FLUSH);
        text.append(some, sizeof some - stream.avail_out);
    }
    inflateEnd(&stream);
    return state == Z_STREAM_END ? std::optional(text) : std::nullopt;
}

/// entry: its header in the directory.
std::optional<std::string> contentOf(std::string_view archive, std::string_view entry) {
    const std::size_t method = two(entry, 10), size = four(entry, 20), header = four(entry, 42);
    const std::size_t begin = header + 30 + two(archive, header + 26) + two(archive, header + 28);
    if (begin > archive.size() || size > archive.size() - begin) return std::nullopt;
    const std::string_view packed = archive.substr(begin, size);
    if (method == 0) return std::string(packed);
    return method == Z_DEFLATED ? inflated(packed) : std::nullopt;
}

} // namespace

std::vector<std::pair<std::string, std::string>> unzipped(std::string_view archive, std::string_view ending) {
    std::vector<std::pair<std::string, std::string>> files;
    const std::size_t end = archive.rfind("PK\5\6");
    if (end == archive.npos) return files;
    std::size_t at = four(archive, end + 16);
    for (std::size_t left = two(archive, end + 10); left > 0 && at < archive.size(); --left) {
        const std::string_view entry = archive.substr(at);
        if (!entry.starts_with("PK\1\2") || !number(entry, 0, 46)) break;
        const std::string_view name = entry.substr(46, two(entry, 28));
        if (name.ends_with(ending))
            if (std::optional<std::string> content = contentOf(archive, entry))
                files.emplace_back(name, std::move(*content));
        at += 46 + two(entry, 28) + two(entry, 30) + two(entry, 32);
    }
    return files;
}

} // namespace tss

#endif
