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

std::string header(const std::string& values, const std::string& file, int width, int height) {
    return fmt::format("set encoding utf8\nFILE = {}\n"
                       "set terminal svg size {},{} font \"Helvetica,13\" background \"white\" noenhanced\n"
                       "set output {}\n"
                       "set border lw 1\nset grid lc rgb \"#dddddd\" lt 1\nset key outside right top Left "
                       "reverse samplen 2\n",
                       quoted(values), width, height, quoted(file));
}

std::string oneLine(std::string text) {
    for (char& c : text)
        if (c == '\n') c = ' ';
    const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
    return first == std::string::npos ? "it does not say why" : text.substr(first, last - first + 1);
}

/// Until the other end is closed; closes this one.
std::string readAll(int from) {
    std::string text;
    char bytes[512];
    for (ssize_t count; (count = read(from, bytes, sizeof bytes)) > 0;)
        text.append(bytes, static_cast<std::size_t>(count));
    close(from);
    return text;
}

/// What gnuplot says is kept from the terminal: it warns of every axis with one value. Nothing where it has
/// drawn, else why not.
std::string runGnuplot(const std::string& folder, const std::string& script) {
    constexpr int notThere = 127; // as shells have it
    const std::string cannot = "gnuplot could not be run";
    int ends[2];
    if (pipe(ends) != 0) return cannot;
    const pid_t child = fork();
    if (child == 0) {
        // In a bare locale it complains of every degree sign.
        if (chdir(folder.c_str()) != 0 || setenv("LC_ALL", "C.UTF-8", 1) != 0) _exit(1);
        for (const int to : {STDOUT_FILENO, STDERR_FILENO}) dup2(ends[1], to);
        close(ends[0]);
        close(ends[1]);
        execlp("gnuplot", "gnuplot", script.c_str(), static_cast<char*>(nullptr));
        _exit(notThere);
    }
    close(ends[1]);
    const std::string said = readAll(ends[0]);
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) return cannot;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
    if (WIFEXITED(status) && WEXITSTATUS(status) == notThere) return cannot + " (Debian package gnuplot-nox)";
    return "gnuplot failed on plots/" + script + ": " + oneLine(said);
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
