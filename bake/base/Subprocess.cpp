#include "bake/base/Subprocess.h"

#include "bake/base/Error.h"

#include <array>
#include <cerrno>
#include <cfenv>
#include <csignal>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <new>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

namespace tss {

namespace {

/// First byte of what the child sends: what follows. The last byte is `whole`, else the message was cut off.
constexpr char result = 'r', refusal = 'e', tooLarge = 'm', whole = '.';

/// Separates the parts of a refusal (an InputError): file, pointer, path, message.
constexpr char partEnd = '\0';

/// Sets up the child: it ends with its parent, has none of the parent's signal handlers and floating-point
/// traps, neither terminal nor core dump, and may use `memory` bytes more than now.
void restrictChild(std::size_t memory) {
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    std::fesetenv(FE_DFL_ENV);
    for (const int fatal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM})
        std::signal(fatal, SIG_DFL);
    if (const int nothing = open("/dev/null", O_RDWR); nothing >= 0)
        for (const int said : {STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, said);
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    std::size_t pages = 0;
    if (std::ifstream("/proc/self/statm") >> pages) {
        rlimit most{};
        getrlimit(RLIMIT_AS, &most);
        most.rlim_cur =
            std::min<rlim_t>(most.rlim_max, pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + memory);
        setrlimit(RLIMIT_AS, &most);
    }
}

std::string answerOf(const std::function<std::string()>& work) {
    try {
        return result + work();
    } catch (const InputError& error) {
        std::string bytes(1, refusal);
        for (const std::string& part : {error.where.file, error.where.pointer, error.where.path})
            bytes += part.substr(0, part.find(partEnd)) + partEnd;
        return bytes + error.message;
    } catch (const std::bad_alloc&) {
        return std::string(1, tooLarge);
    }
}

[[noreturn]] void answer(const std::function<std::string()>& work, int to) {
    int status = EXIT_FAILURE;
    try {
        const std::string bytes = answerOf(work) + whole;
        for (std::size_t sent = 0; sent < bytes.size();) {
            const ssize_t count = write(to, bytes.data() + sent, bytes.size() - sent);
            if (count < 0 && errno != EINTR) _exit(EXIT_FAILURE);
            if (count > 0) sent += static_cast<std::size_t>(count);
        }
        status = EXIT_SUCCESS;
    } catch (...) { // it ends without a result
    }
    _exit(status);
}

std::string readAll(int from) {
    std::string bytes;
    std::array<char, 1 << 16> some;
    for (;;) {
        const ssize_t count = read(from, some.data(), some.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return bytes;
        bytes.append(some.data(), static_cast<std::size_t>(count));
    }
}

[[noreturn]] void refuse(const std::string& bytes) {
    std::array<std::string, 3> places;
    std::size_t at = 0;
    for (std::string& place : places) {
        const std::size_t end = bytes.find(partEnd, at);
        place = bytes.substr(at, end - at);
        at = end + 1;
    }
    throw InputError(Where{places[0], places[1], places[2]}, bytes.substr(at));
}

} // namespace

std::string runInSubprocess(const std::function<std::string()>& work, std::size_t memory) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw SubprocessFailed("no pipe to another process can be had");
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        restrictChild(memory);
        answer(work, ends[1]);
    }
    close(ends[1]);
    std::string bytes = child < 0 ? "" : readAll(ends[0]);
    close(ends[0]);
    if (child < 0) throw SubprocessFailed("no other process can be had");
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (bytes.size() < 2 || bytes.back() != whole)
        throw SubprocessFailed(WIFSIGNALED(status) ? fmt::format("crashes (signal {})", WTERMSIG(status))
                                                   : "ends without a result");
    bytes.pop_back();
    const char kind = bytes[0];
    bytes.erase(0, 1);
    if (kind == tooLarge)
        throw SubprocessFailed(fmt::format("takes more than {} MB of memory", memory >> 20));
    if (kind == refusal) refuse(bytes);
    return bytes;
}

} // namespace tss
