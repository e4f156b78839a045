#include "bake/base/AtomicFile.h"

#include "bake/base/Error.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace tss {

namespace {

[[noreturn]] void fail(const std::string& file, const std::string& what) {
    throw InputError(Where{file}, what + ": " + std::strerror(errno));
}

/// Closes on the way out, and removes the file again unless it was kept.
struct Temporary {
    int descriptor = -1;
    std::string name;
    bool kept = false;
    ~Temporary() {
        if (descriptor >= 0) ::close(descriptor);
        if (!kept && !name.empty()) ::unlink(name.c_str());
    }
};

} // namespace

void writeFileAtomically(const std::string& file, std::string_view content) {
    // A link is followed, so that the file it names is replaced and the link stays.
    std::error_code error;
    const std::filesystem::path resolved = std::filesystem::weakly_canonical(file, error);
    const std::string target = error ? file : resolved.string();
    struct stat status {};
    const bool exists = ::stat(target.c_str(), &status) == 0;
    if (exists && !S_ISREG(status.st_mode))
        throw InputError(Where{file}, "cannot be written: expected a regular file");

    Temporary temporary;
    std::string pattern = target + ".XXXXXX";
    temporary.descriptor = ::mkstemp(pattern.data());
    if (temporary.descriptor < 0) fail(file, "cannot be written");
    temporary.name = pattern;
    while (!content.empty()) {
        const ssize_t written = ::write(temporary.descriptor, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(file, "cannot be written");
        content.remove_prefix(static_cast<std::size_t>(written));
    }
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(temporary.descriptor, exists ? status.st_mode & 07777 : 0666 & ~mask);
    const int closed = ::close(temporary.descriptor);
    temporary.descriptor = -1;
    if (closed != 0) fail(file, "cannot be written");
    if (::rename(temporary.name.c_str(), target.c_str()) != 0) fail(file, "cannot be written");
    temporary.kept = true;
}

std::string readWholeFile(const std::string& file) {
    Temporary open;
    open.kept = true;
    // Without waiting for whoever would write into a pipe: that is refused below.
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
    return content;
}

bool isWithin(const std::filesystem::path& path, const std::filesystem::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

} // namespace tss
