#include "bake/report/Drawing.h"
#include "bake/base/AtomicFile.h"
#include "bake/report/Text.h"
#include "tests/report/Arm.h"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fcntl.h>

using namespace tss;
using namespace tss::reporting;

namespace {

/// What this process and those it starts write to standard error meanwhile.
class Terminal {
public:
    explicit Terminal(std::string file) : file_(std::move(file)), before_(dup(STDERR_FILENO)) {
        const int to = open(file_.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
        dup2(to, STDERR_FILENO);
        close(to);
    }
    ~Terminal() {
        dup2(before_, STDERR_FILENO);
        close(before_);
    }
    std::string text() const { return readWholeFile(file_); }

private:
    std::string file_;
    int before_;
};

} // namespace

TEST_CASE("gnuplot warns of an axis with one value, and the terminal stays empty") {
    const OutFolder folder;
    Drawing drawing(folder.path, "");
    const Terminal terminal(folder.path + "/said");
    drawing.draw("one", "1 1\n", "plot FILE using 1:2\n", "");
    CHECK(terminal.text().empty());
    CHECK(drawing.problem.empty());
    CHECK(drawing.plots.size() == 1);
}

TEST_CASE(
    "a script that gnuplot refuses is told with gnuplot's reason, a program that is not there by name") {
    const OutFolder folder;
    Drawing drawing(folder.path, "");
    drawing.draw("bad", "1 1\n", "plot nonsense(\n", "");
    CHECK_THAT(drawing.problem,
               Catch::StartsWith("gnuplot failed on plots/bad.gp") && Catch::Contains("nonsense"));
    CHECK(drawing.plots.empty());
    const std::string path = std::getenv("PATH");
    setenv("PATH", "/nowhere", 1);
    drawing.draw("good", "1 1\n2 2\n", "plot FILE using 1:2\n", "");
    setenv("PATH", path.c_str(), 1);
    CHECK_THAT(drawing.problem, Catch::StartsWith("gnuplot could not be run (Debian package gnuplot-nox)"));
    CHECK(drawing.plots.empty());
}

TEST_CASE("a body may be called FILE") {
    const OutFolder folder;
    Drawing drawing(folder.path, "FILE-");
    drawing.draw("a", "1 1\n2 2\n", "set title \"PROFILE\"\nplot FILE using 1:2 notitle\n", "");
    REQUIRE(drawing.plots.size() == 1);
    CHECK(readWholeFile(folder.path + "/plots/FILE-a.svg").find("PROFILE") != std::string::npos);
}

TEST_CASE("a plot is found by its own name, whatever the pair's path has in it") {
    const std::vector<Plot> plots{{"plots/memory-Joint-pareto.svg", "errors"},
                                  {"plots/memory-Joint-memory.svg", "bytes"}};
    CHECK_THAT(pictureText(plots, "memory"), Catch::Contains("bytes"));
    CHECK(pictureText(plots, "steps").empty());
}
