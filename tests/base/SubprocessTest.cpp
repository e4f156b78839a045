#include "bake/base/Subprocess.h"

#include "bake/base/Error.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <unistd.h>
#include <vector>

using namespace tss;

namespace {

constexpr std::size_t plenty = std::size_t(1) << 30; // bytes

std::string endOf(const std::function<std::string()>& work, std::size_t memory = plenty) {
    try {
        runInSubprocess(work, memory);
    } catch (const SubprocessFailed& end) {
        return end.what();
    }
    return "";
}

} // namespace

TEST_CASE("what another process makes comes back whole, however long, and changes nothing here") {
    int here = 1;
    const std::string bytes = runInSubprocess(
        [&] {
            here = 2;
            return std::string(10'000'000, '.') + '\0' + "end";
        },
        plenty);
    CHECK(here == 1);
    CHECK(bytes == std::string(10'000'000, '.') + '\0' + "end");
    CHECK(runInSubprocess([] { return std::string(); }, plenty).empty());
}

TEST_CASE("a refusal comes back with its place") {
    try {
        runInSubprocess(
            []() -> std::string {
                throw InputError(Where{"a.obj", "/1", "/b"}, "is odd");
            },
            plenty);
        FAIL("expected a refusal");
    } catch (const InputError& error) {
        CHECK(error.where.file == "a.obj");
        CHECK(error.where.pointer == "/1");
        CHECK(error.where.path == "/b");
        CHECK(error.message == "is odd");
    }
}

TEST_CASE("a crash, an exit and other errors of what is done in another process are told, and it prints nothing") {
    CHECK(endOf([]() -> std::string { std::abort(); }) == "crashes (signal 6)");
    CHECK(endOf([]() -> std::string {
              std::raise(SIGSEGV);
              return "";
          }) == "crashes (signal 11)");
    CHECK(endOf([]() -> std::string { _exit(0); }) == "ends without a result");
    CHECK(endOf([]() -> std::string { throw 1; }) == "ends without a result");
    CHECK(endOf([]() -> std::string { throw std::bad_alloc(); }) == "takes more than 1024 MB of memory");
}

// The sanitizers end a program that gets no more.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_CASE("what is done in another process has no more memory than it is given") {
    const auto greedy = [] {
        const std::vector<char> much(std::size_t(400) << 20);
        return std::string(1, much.back());
    };
    CHECK(endOf(greedy).empty());
    CHECK(endOf(greedy, std::size_t(100) << 20) == "takes more than 100 MB of memory");
}
#endif
