#include "tests/tool/Shell.h"

#include <cstdlib>
#include <fstream>
#include <iterator>
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
