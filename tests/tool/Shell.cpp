#include "tests/tool/Shell.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace fs = std::filesystem;

Folder::Folder() {
    std::string pattern = (fs::temp_directory_path() / "tss-test-XXXXXX").string();
    if (!mkdtemp(pattern.data())) throw std::runtime_error("no temporary folder");
    path_ = pattern;
}

Folder::~Folder() {
    std::error_code ignored;
    if (!std::getenv("TSS_TEST_KEEP")) fs::remove_all(path_, ignored);
}

std::string readText(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

void writeText(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

std::size_t fileCount(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

Ran runTss(const std::string& arguments, const fs::path& folder, const std::string& before) {
    const Folder capture;
    const std::string command = "cd '" + folder.string() + "' && " + before + " && '" TSS_PROGRAM "' " +
                                arguments + " >'" + (capture / "out") + "' 2>'" + (capture / "err") +
                                "' </dev/null";
    const int status = std::system(command.c_str());
    Ran ran;
    ran.exit = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ran.out = readText(capture / "out");
    ran.err = readText(capture / "err");
    return ran;
}

std::vector<Ran> runPage(const std::string& page, const fs::path& folder) {
    fs::copy(OSGTSS_SOURCE_DIR "/examples/arm", folder / "arm");
    std::istringstream lines(readText(fs::path(OSGTSS_SOURCE_DIR "/docs") / page));
    std::vector<Ran> commands;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("    tss ")) continue;
        commands.push_back(runTss(line.substr(8), folder));
        INFO(line << "\n" << commands.back().out << commands.back().err);
        REQUIRE(commands.back().exit == 0);
    }
    return commands;
}
