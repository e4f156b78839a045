#ifdef OSGTSS_IMPORT
#include "bake/geometry/NearbyFiles.h"

#include "bake/base/AtomicFile.h"
#include "bake/base/Error.h"

#include <cstdint>
#include <fstream>

namespace tss {

namespace fs = std::filesystem;

namespace {

fs::path realPath(const fs::path& path) {
    std::error_code error;
    const fs::path whole = fs::absolute(path, error), real = fs::weakly_canonical(whole, error);
    return error ? whole.lexically_normal() : real;
}

/// Little-endian, as glTF has it.
std::uint32_t readNumber(std::istream& stream) {
    unsigned char bytes[4] = {};
    stream.read(reinterpret_cast<char*>(bytes), 4);
    return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

} // namespace

NearbyFiles::NearbyFiles(const std::string& file)
    : file_(file), folder_(realPath(fs::absolute(file).parent_path())),
      realFolder_(realPath(file).parent_path()) {}

std::string NearbyFiles::whyNot(const std::string& file) const {
    if (fs::path(file) == file_) return "";
    const fs::path real = realPath(file);
    if (!isWithin(real, folder_) && !isWithin(real, realFolder_))
        return file + " lies outside of " + folder_.string() + ", the folder of the mesh";
    std::error_code none;
    return fs::exists(real, none) && !fs::is_regular_file(real, none) ? file + " is not a regular file" : "";
}

bool NearbyFiles::Exists(const char* file) const {
    std::error_code none;
    return whyNot(file).empty() && fs::is_regular_file(file, none);
}

Assimp::IOStream* NearbyFiles::Open(const char* file, const char* mode) {
    const std::string why = whyNot(file);
    if (why.empty()) return DefaultIOSystem::Open(file, mode);
    refused_ = why;
    return nullptr;
}

void expectEndedPly(const std::string& file) {
    constexpr std::size_t most = 1 << 16; // of a header
    std::ifstream stream(file, std::ios::binary);
    std::string begin(most, '\0');
    stream.read(begin.data(), most);
    begin.resize(static_cast<std::size_t>(stream.gcount()));
    if ((begin.starts_with("ply") || begin.starts_with("PLY")) && begin.find("end_header") == begin.npos)
        throw InputError(Where{file}, "cannot be read as a mesh: its header has no line end_header");
}

void expectWholeGlb(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    char magic[4] = {};
    stream.read(magic, 4);
    if (!stream || std::string(magic, 4) != "glTF") return; // what it is the importer says
    std::error_code error;
    const std::uint64_t size = fs::file_size(file, error);
    constexpr std::uint64_t header = 12, ofChunk = 8; // version and length; a chunk's length and type
    for (std::uint64_t at = header; !error && at + ofChunk <= size;) {
        stream.seekg(static_cast<std::streamoff>(at));
        const std::uint64_t length = readNumber(stream), left = size - at - ofChunk;
        if (length > left)
            throw InputError(Where{file}, "is cut short: a chunk has " + std::to_string(length) +
                                              " bytes, and " + std::to_string(left) + " are left");
        at += ofChunk + length;
    }
}

} // namespace tss

#endif
