#include "bake/base/AtomicFile.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace tss {

namespace {

[[noreturn]] void fail(const std::string& file, const std::string& what) {
    throw InputError(Where{file}, what + ": " + std::strerror(errno));
}

/// An open file that is closed at the end of the scope and, unless `kept`, removed.
struct Temporary {
    int descriptor = -1;
    std::string name;
    bool kept = false;
    Temporary() = default;
    Temporary(Temporary&& other) noexcept
        : descriptor(std::exchange(other.descriptor, -1)), name(std::exchange(other.name, {})),
          kept(other.kept) {}
    ~Temporary() {
        if (descriptor >= 0) ::close(descriptor);
        if (!kept && !name.empty()) ::unlink(name.c_str());
    }
};

/// The file that a name stands for, symbolic links resolved: the file is replaced and the links stay.
struct Target {
    std::string name;
    std::optional<mode_t> mode; ///< permissions of the existing file
};

/// Throws InputError where that is no regular file.
Target targetOf(const std::string& file) {
    constexpr int mostLinks = 40;
    std::filesystem::path path = file;
    std::error_code none;
    for (int k = 0; k < mostLinks && std::filesystem::is_symlink(path, none); ++k)
        path = path.parent_path() / std::filesystem::read_symlink(path, none);
    Target target{path.string(), {}};
    struct stat status {};
    if (::stat(target.name.c_str(), &status) != 0) return target;
    if (!S_ISREG(status.st_mode)) throw InputError(Where{file}, "cannot be written: expected a regular file");
    target.mode = status.st_mode & 07777;
    return target;
}

/// A file beside the target, under a name that is not too long where the target's is not.
Temporary temporaryFor(const Target& target, const std::string& file) {
    constexpr std::size_t longest = 240; // of 255 bytes
    const std::filesystem::path path = target.name;
    std::string pattern =
        (path.parent_path() / path.filename().string().substr(0, longest)).string() + ".XXXXXX";
    Temporary temporary;
    temporary.descriptor = ::mkstemp(pattern.data());
    if (temporary.descriptor < 0) fail(file, "cannot be written");
    temporary.name = pattern;
    return temporary;
}

} // namespace

void expectWritable(const std::string& file) {
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    std::error_code none;
    if (!folder.empty() && !std::filesystem::is_directory(folder, none))
        throw InputError(Where{file}, "cannot be written: there is no folder " + folder.string());
    if (std::filesystem::is_directory(file, none))
        throw InputError(Where{file}, "cannot be written: it is a folder");
    const Target target = targetOf(file);
    if (std::filesystem::path(target.name).filename().string().size() > NAME_MAX) {
        errno = ENAMETOOLONG;
        fail(file, "cannot be written");
    }
    temporaryFor(target, file);
}

void writeFileAtomically(const std::string& file, std::string_view content) {
    const Target target = targetOf(file);
    Temporary temporary = temporaryFor(target, file);
    while (!content.empty()) {
        const ssize_t written = ::write(temporary.descriptor, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(file, "cannot be written");
        content.remove_prefix(static_cast<std::size_t>(written));
    }
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(temporary.descriptor, target.mode ? *target.mode : 0666 & ~mask);
    const int closed = ::close(temporary.descriptor);
    temporary.descriptor = -1;
    if (closed != 0) fail(file, "cannot be written");
    if (::rename(temporary.name.c_str(), target.name.c_str()) != 0) fail(file, "cannot be written");
    temporary.kept = true;
}

std::string readWholeFile(const std::string& file) {
    Temporary open;
    open.kept = true;
    // O_NONBLOCK: opening a pipe must not wait for a writer; it is refused below.
    open.descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (open.descriptor < 0) fail(file, "cannot be read");
    struct stat status {};
    if (::fstat(open.descriptor, &status) != 0) fail(file, "cannot be read");
    if (!S_ISREG(status.st_mode)) throw InputError(Where{file}, "cannot be read: expected a regular file");
    std::string content(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t have = 0;
    while (have < content.size()) {
        const ssize_t got = ::read(open.descriptor, content.data() + have, content.size() - have);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(file, "cannot be read");
        if (got == 0) break;
        have += static_cast<std::size_t>(got);
    }
    content.resize(have);
    expectFetched(file, content);
    return content;
}

bool isWithin(const std::filesystem::path& path, const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

} // namespace tss
