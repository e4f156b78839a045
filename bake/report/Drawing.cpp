#include "bake/report/Drawing.h"

#include "bake/base/AtomicFile.h"

#include <filesystem>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tss::reporting {

namespace {

const char* const colours[] = {"#0060ad", "#dd181f", "#2a8c2a", "#e08a00", "#7a3db8", "#00939a",
                               "#a0522d", "#d6589f", "#5b5b5b", "#8a9a00", "#1f1f1f", "#4aa8ff"};

std::string header(const std::string& file, int width, int height) {
    return fmt::format("set encoding utf8\n"
                       "set terminal svg size {},{} font \"Helvetica,13\" background \"white\" noenhanced\n"
                       "set output {}\n"
                       "set border lw 1\nset grid lc rgb \"#dddddd\" lt 1\nset key outside right top Left "
                       "reverse samplen 2\n",
                       width, height, quoted(file));
}

/// False where it cannot be run or fails.
bool runGnuplot(const std::string& folder, const std::string& script) {
    const pid_t child = fork();
    if (child < 0) return false;
    if (child == 0) {
        // In a bare locale it complains of every degree sign.
        if (chdir(folder.c_str()) != 0 || setenv("LC_ALL", "C.UTF-8", 1) != 0) _exit(127);
        execlp("gnuplot", "gnuplot", script.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

} // namespace

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out + '"';
}

const char* colour(std::size_t k) {
    return colours[k % std::size(colours)];
}

Drawing::Drawing(std::string folder, std::string stem) : folder_(std::move(folder)), stem_(std::move(stem)) {
    std::filesystem::create_directories(folder_ + "/plots");
}

void Drawing::draw(const std::string& name, const std::string& data, std::string script,
                   const std::string& caption, int width, int height) {
    const std::string values = stem_ + name + ".dat", commands = stem_ + name + ".gp",
                      picture = stem_ + name + ".svg";
    for (std::size_t at; (at = script.find("FILE")) != std::string::npos;)
        script.replace(at, 4, quoted(values));
    writeFileAtomically(folder_ + "/plots/" + values, data);
    writeFileAtomically(folder_ + "/plots/" + commands, header(picture, width, height) + script);
    if (runGnuplot(folder_ + "/plots", commands))
        plots.push_back({"plots/" + picture, caption});
    else
        problem = "gnuplot could not be run: the scripts and data are in plots/, no picture was drawn";
}

} // namespace tss::reporting
