#include "bake/report/Drawing.h"

#include "bake/base/AtomicFile.h"

#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <sys/wait.h>

namespace tss::reporting {

namespace {

const char* const colours[] = {"#0060ad", "#dd181f", "#2a8c2a", "#e08a00", "#7a3db8", "#00939a",
                               "#a0522d", "#d6589f", "#5b5b5b", "#8a9a00", "#1f1f1f", "#4aa8ff"};

std::string header(const std::string& values, const std::string& file, int width, int height) {
    return fmt::format("set encoding utf8\nFILE = {}\n"
                       "set terminal svg size {},{} font \"Helvetica,13\" background \"white\" noenhanced\n"
                       "set output {}\n"
                       "set border lw 1\nset grid lc rgb \"#dddddd\" lt 1\nset key outside right top Left "
                       "reverse samplen 2\n",
                       inQuotes(values), width, height, inQuotes(file));
}

std::string oneLine(std::string text) {
    for (char& c : text)
        if (c == '\n') c = ' ';
    const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    return first == std::string::npos ? "it does not say why" : text.substr(first, last - first + 1);
}

/// What gnuplot says is kept from the terminal: it warns of every axis with one value. Nothing where it has
/// drawn, else why not.
std::string runGnuplot(const std::string& folder, const std::string& script) {
    constexpr int notThere = 127; // as shells have it
    const std::string cannot = "gnuplot could not be run";
    // In a bare locale it complains of every degree sign.
    const std::string command =
        fmt::format("cd {} && LC_ALL=C.UTF-8 gnuplot {} 2>&1", shellWord(folder), shellWord(script));
    std::FILE* const pipe = popen(command.c_str(), "r");
    if (!pipe) return cannot;
    std::string said;
    char bytes[512];
    while (const std::size_t count = std::fread(bytes, 1, sizeof bytes, pipe)) said.append(bytes, count);
    const int status = pclose(pipe);
    if (status == 0) return "";
    if (WIFEXITED(status) && WEXITSTATUS(status) == notThere) return cannot + " (Debian package gnuplot-nox)";
    return "gnuplot failed on plots/" + script + ": " + oneLine(said);
}

} // namespace

const char* colour(std::size_t k) {
    return colours[k % std::size(colours)];
}

Drawing::Drawing(std::string folder, std::string stem) : folder_(std::move(folder)), stem_(std::move(stem)) {
    std::filesystem::create_directories(folder_ + "/plots");
}

void Drawing::draw(const std::string& name, const std::string& data, const std::string& script,
                   const std::string& caption, int width, int height) {
    const std::string values = stem_ + name + ".dat", commands = stem_ + name + ".gp",
                      picture = stem_ + name + ".svg";
    writeFileAtomically(folder_ + "/plots/" + values, data);
    writeFileAtomically(folder_ + "/plots/" + commands, header(values, picture, width, height) + script);
    const std::string wrong = runGnuplot(folder_ + "/plots", commands);
    if (wrong.empty())
        plots.push_back({"plots/" + picture, caption});
    else
        problem = wrong + "; what is not drawn is in plots/ as script and data";
}

} // namespace tss::reporting
