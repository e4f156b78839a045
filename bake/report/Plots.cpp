#include "bake/report/Plots.h"

#include "bake/base/AtomicFile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <map>
#include <sys/wait.h>
#include <unistd.h>

namespace tss::reporting {

namespace {

/// What is drawn at the bottom of a logarithmic axis for an error of 0, in millimetres.
constexpr double noError = 1e-3;

const char* const colours[] = {"#0060ad", "#dd181f", "#2a8c2a", "#e08a00", "#7a3db8", "#00939a",
                               "#a0522d", "#d6589f", "#5b5b5b", "#8a9a00", "#1f1f1f", "#4aa8ff"};

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    out += '"';
    return out;
}

std::string header(const std::string& file, int width, int height) {
    return fmt::format("set encoding utf8\n"
                       "set terminal svg size {},{} font \"Helvetica,13\" background \"white\" noenhanced\n"
                       "set output {}\n"
                       "set border lw 1\nset grid lc rgb \"#dddddd\" lt 1\nset key outside right top Left "
                       "reverse samplen 2\n",
                       width, height, quoted(file));
}

/// Collects the plots of one pair: writes data and script, runs gnuplot, keeps what was drawn.
class Drawing {
public:
    Drawing(std::string folder, std::string stem) : folder_(std::move(folder)), stem_(std::move(stem)) {}

    std::string data(const std::string& name, const std::string& text) {
        const std::string file = stem_ + name + ".dat";
        writeFileAtomically(folder_ + "/plots/" + file, text);
        return quoted(file);
    }
    void draw(const std::string& name, const std::string& body, const std::string& caption, int width = 900,
              int height = 560) {
        const std::string script = stem_ + name + ".gp", picture = stem_ + name + ".svg";
        writeFileAtomically(folder_ + "/plots/" + script, header(picture, width, height) + body);
        if (runGnuplot(folder_ + "/plots", script))
            plots.push_back({"plots/" + picture, caption});
        else
            problem = "gnuplot could not be run: the scripts and data are in plots/, no picture was drawn";
    }
    std::vector<Plot> plots;
    std::string problem;

private:
    std::string folder_, stem_;
};

double errorOf(const Row& row, double millimetres) {
    return std::max(noError, row.worst() * millimetres);
}

/// Error against time: one series a family, hollow where contacts were missed, the Pareto front as steps.
void drawPareto(Drawing& drawing, const PairStudy& study) {
    std::map<std::string, std::array<std::string, 2>> families;
    std::vector<std::pair<double, double>> points;
    for (const Row& row : study.rows) {
        if (!(row.times.median > 0)) continue;
        const double error = errorOf(row, study.millimetres);
        families[row.about.family][row.misses() > 0 ? 1 : 0] +=
            fmt::format("{} {} \"{}\"\n", row.times.median, error, row.method);
        points.emplace_back(row.times.median, error);
    }
    std::sort(points.begin(), points.end());
    std::string front;
    double best = INFINITY;
    for (const auto& [time, error] : points)
        if (error < best) {
            best = error;
            front += fmt::format("{} {}\n", time, error);
        }
    if (!points.empty()) front += fmt::format("{} {}\n", points.back().first * 1.5, best);
    std::string text,
        body = fmt::format("set logscale xy\nset format x \"10^{{%L}}\"\nset format y \"10^{{%L}}\"\n"
                           "set xlabel \"time a query, ns (median)\"\n"
                           "set ylabel \"worst error, mm\"\n"
                           "set title \"Error against run time: {} against {}\"\n"
                           "set yrange [{}:*]\nset termoption enhanced\n",
                           study.nameB, study.nameA, noError * 0.7);
    std::string plots;
    int index = 0, colour = 0;
    const std::string file = "$DATA";
    for (const auto& [family, kinds] : families) {
        for (int missing = 0; missing < 2; ++missing) {
            if (kinds[static_cast<std::size_t>(missing)].empty()) continue;
            text += kinds[static_cast<std::size_t>(missing)] + "\n\n";
            plots += fmt::format(", {} index {} using 1:2 with points pt {} ps 1.1 lc rgb \"{}\" title {}",
                                 file, index, missing ? 6 : 7, colours[colour % 12],
                                 quoted(missing ? family + " (misses contacts)" : family));
            ++index;
        }
        ++colour;
    }
    text += front;
    const std::string name = drawing.data("pareto", text);
    body += fmt::format(
        "plot {} index {} using 1:2 with steps lw 1.5 dt 2 lc rgb \"#444444\" title \"Pareto front\"{}\n",
        name, index, plots);
    for (std::size_t at; (at = body.find(file)) != std::string::npos;) body.replace(at, file.size(), name);
    drawing.draw(
        "pareto", body,
        fmt::format("Worst error against the meshes (deepest contact missed or farthest early contact, over "
                    "uniform and near-contact poses) against the time of a query. Methods without any error "
                    "stand at {} mm. Hollow: the method missed contacts.",
                    noError),
        1100, 620);
}

void drawSteps(Drawing& drawing, const PairStudy& study) {
    const StepStudy& steps = study.steps;
    std::string text = "# step leading touching inRegion";
    for (const StepSeries& series : steps.series) text += " " + quoted(series.name);
    text += "\n";
    for (std::size_t s = 0; s < steps.leading.size(); ++s) {
        text +=
            fmt::format("{} {} {} {}", s, steps.leading[s], int(steps.touching[s]), int(steps.inRegion[s]));
        for (const StepSeries& series : steps.series) text += fmt::format(" {}", series.tests[s]);
        text += "\n";
    }
    const std::string name = drawing.data("steps", text);
    std::string body = fmt::format("set logscale y\nset xlabel \"step of the motion\"\n"
                                   "set ylabel \"sphere tests a step\"\nset yrange [0.7:*]\n"
                                   "set title \"Tests a step along {}\"\n"
                                   "set style fill solid 0.15 noborder\nplot ",
                                   steps.motion);
    // A step without any test has no place on a logarithmic axis: it is drawn at the bottom, as 0.8.
    body += fmt::format(
        "{} using 1:($4 > 0 ? 1e9 : NaN) with filledcurves x1 fc rgb \"#aaaaaa\" fs solid 0.0 notitle", name);
    for (std::size_t k = 0; k < steps.series.size(); ++k)
        body += fmt::format(", {} using 1:(${} > 0.8 ? ${} : 0.8) with lines lw 2 lc rgb \"{}\" title {}",
                            name, k + 5, k + 5, colours[k % 12], quoted(steps.series[k].name));
    body += fmt::format(", {} using 1:($3 > 0 ? 0.9 : NaN) with points pt 5 ps 0.4 lc rgb \"#dd181f\" title "
                        "\"meshes touch\"\n",
                        name);
    drawing.draw("steps", body, "Sphere tests a step along the motion (the paper's Figure 2j).", 1100, 560);
}

void drawRegion(Drawing& drawing, const PairStudy& study) {
    std::string text;
    for (std::size_t k = 0; k < study.region.middle.size(); ++k)
        text += fmt::format("{} {}\n", study.region.middle[k], 100 * study.region.share[k]);
    const std::string name = drawing.data("region", text);
    drawing.draw(
        "region",
        fmt::format("set xlabel \"{}, {}\"\nset ylabel \"poses that collide, %\"\nset yrange [0:105]\n"
                    "set title \"Angular region of collision\"\n"
                    "set obj 1 rect from {},0 to {},105 fc rgb \"#dd181f\" fs solid 0.08 noborder behind\n"
                    "plot {} using 1:2 with lines lw 2 lc rgb \"#0060ad\" title \"sphere model\", "
                    "NaN with boxes fs solid 0.15 lc rgb \"#dd181f\" title \"region\"\n",
                    study.leadingDof, study.leadingUnit, study.region.lower, study.region.upper, name),
        "Share of poses that collide by the leading DOF, the other DOFs anywhere in their limits (the "
        "paper's "
        "Figure 2i); shaded: the angular region of collision.");
}

void drawSampling(Drawing& drawing, const PairStudy& study) {
    std::map<std::string, std::string> series;
    for (const SamplingPoint& point : study.sampling)
        series[point.reduce] +=
            fmt::format("{} {} {} {}\n", point.samples, std::max(1e-3, 100 * point.missedUniform),
                        std::max(1e-3, 100 * point.missedNear), point.tests);
    std::string text, plots;
    int index = 0;
    for (const auto& [reduce, points] : series) {
        text += points + "\n\n";
        for (const int column : {2, 3})
            plots += fmt::format(
                "{}FILE index {} using 1:{} with linespoints lw 2 pt {} dt {} lc rgb \"{}\" title \"{}, {}\"",
                plots.empty() ? "" : ", ", index, column, column == 2 ? 7 : 6, column == 2 ? 1 : 2,
                colours[index], reduce == "none" ? "sampled search alone" : "with the paper's reduction",
                column == 2 ? "uniform poses" : "near contact");
        ++index;
    }
    const std::string name = drawing.data("sampling", text);
    for (std::size_t at; (at = plots.find("FILE")) != std::string::npos;) plots.replace(at, 4, name);
    drawing.draw("sampling",
                 fmt::format("set logscale xy\nset xlabel \"poses explored when baking\"\n"
                             "set ylabel \"colliding poses missed, %\"\nset yrange [0.0007:*]\n"
                             "set title \"What a sampled search misses\"\nplot {}\n",
                             plots),
                 "Poses at which the whole sphere model collides and a table from a sampled search does not, "
                 "on poses it "
                 "has not seen. 0 stands at 0.001 %. A certified table is at 0 by proof.",
                 1000, 540);
}

void drawEpsilon(Drawing& drawing, const PairStudy& study) {
    std::string text;
    double least = INFINITY;
    for (const EpsilonPoint& point : study.epsilons)
        if (point.epsilon > 0) least = std::min(least, point.epsilon * study.millimetres);
    if (!std::isfinite(least)) least = 1e-3;
    for (const EpsilonPoint& point : study.epsilons)
        text += fmt::format("{} {} {}\n", point.epsilon > 0 ? point.epsilon * study.millimetres : least / 10,
                            point.tests, point.lowerBound);
    const std::string name = drawing.data("epsilon", text);
    drawing.draw(
        "epsilon",
        fmt::format("set logscale x\nset xlabel \"epsilon, mm (leftmost: 0, lossless)\"\nset ylabel \"tests "
                    "a step\"\n"
                    "set yrange [0:*]\nset title \"Table size against epsilon\"\n"
                    "plot {} using 1:2 with linespoints lw 2 pt 7 lc rgb \"#0060ad\" title \"tests\", "
                    "{} using 1:($3 > 0 ? $3 : NaN) with linespoints lw 2 dt 2 pt 6 lc rgb \"#5b5b5b\" title "
                    "\"lower bound\"\n",
                    name, name),
        "Tests a step against epsilon, with the bound below which no table of the same answers can be.");
}

void drawBake(Drawing& drawing, const PairStudy& study) {
    std::string text;
    for (const BakePoint& point : study.bakes)
        text += fmt::format("{} {} {} {} {}\n", point.spheresA + point.spheresB, point.sphereSeconds,
                            point.tableSeconds, point.tests, point.tolerance * study.millimetres);
    const std::string name = drawing.data("bake", text);
    drawing.draw(
        "bake",
        fmt::format("set logscale xy\nset xlabel \"spheres of both bodies\"\nset ylabel \"seconds\"\nset "
                    "y2label \"tests a step\"\n"
                    "set logscale y2\nset ytics nomirror\nset y2tics\nset key outside top center horizontal\n"
                    "set title \"Bake time and table size against the number of spheres\"\n"
                    "plot {0} using 1:2 with linespoints lw 2 pt 7 lc rgb \"#0060ad\" title \"spheres, s\", "
                    "{0} using 1:3 with linespoints lw 2 pt 7 lc rgb \"#dd181f\" title \"table, s\", "
                    "{0} using 1:4 axes x1y2 with linespoints lw 2 dt 2 pt 6 lc rgb \"#2a8c2a\" title "
                    "\"tests (right)\"\n",
                    name),
        "Seconds to make spheres and table, and the table's tests, as the tolerance falls.");
}

void drawMemory(Drawing& drawing, const PairStudy& study) {
    std::map<std::string, std::string> families;
    for (const Row& row : study.rows)
        if (row.about.bytes > 0)
            families[row.about.family] +=
                fmt::format("{} {}\n", row.about.bytes, errorOf(row, study.millimetres));
    std::string text, plots;
    int index = 0;
    for (const auto& [family, points] : families) {
        text += points + "\n\n";
        plots += fmt::format("{}FILE index {} using 1:2 with points pt 7 ps 1.1 lc rgb \"{}\" title {}",
                             index ? ", " : "", index, colours[index % 12], quoted(family));
        ++index;
    }
    const std::string name = drawing.data("memory", text);
    for (std::size_t at; (at = plots.find("FILE")) != std::string::npos;) plots.replace(at, 4, name);
    drawing.draw("memory",
                 fmt::format("set logscale xy\nset termoption enhanced\nset format x \"10^{{%L}}\"\nset "
                             "format y \"10^{{%L}}\"\n"
                             "set xlabel \"bytes that a query reads from\"\nset ylabel \"worst error, "
                             "mm\"\nset yrange [{}:*]\n"
                             "set title \"Error against memory\"\nplot {}\n",
                             noError * 0.7, plots),
                 "The same errors against what each method keeps in memory.", 1100, 560);
}

} // namespace

bool runGnuplot(const std::string& folder, const std::string& script) {
    const pid_t child = fork();
    if (child < 0) return false;
    if (child == 0) {
        if (chdir(folder.c_str()) != 0) _exit(127);
        execlp("gnuplot", "gnuplot", script.c_str(), static_cast<char*>(nullptr));
        _exit(127);
    }
    int status = 0;
    return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

std::vector<Plot> drawPlots(const PairStudy& study, const std::string& folder, const std::string& stem,
                            std::string& problem) {
    std::filesystem::create_directories(folder + "/plots");
    Drawing drawing(folder, stem);
    drawPareto(drawing, study);
    drawSteps(drawing, study);
    drawRegion(drawing, study);
    drawSampling(drawing, study);
    drawEpsilon(drawing, study);
    drawBake(drawing, study);
    drawMemory(drawing, study);
    if (!drawing.problem.empty()) problem = drawing.problem;
    return drawing.plots;
}

} // namespace tss::reporting
