#include "bake/report/Drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <map>

namespace tss::reporting {

namespace {

/// The same for the share of wrong verdicts, per cent: less than one pose of those judged.
constexpr double leastWrongDrawn = 1e-3;

double errorOf(const Row& row, double millimetres) {
    return std::max(leastErrorDrawn, row.worst() * millimetres);
}

/// One axis of a plot of all rows.
struct Axis {
    std::string label;
    std::function<double(const Row&)> value;
};

std::string powersOfTen(const std::string& axes) {
    std::string text = fmt::format("set logscale {}\nset termoption enhanced\n", axes);
    for (const char axis : axes) text += fmt::format("set format {} \"10^{{%L}}\"\n", axis);
    return text;
}

/// Error against cost: one series a family, hollow where contacts were missed. front: also draw which rows no
/// other beats in both.
void drawErrors(Drawing& drawing, const PairStudy& study, const std::string& name, const std::string& title,
                const Axis& x, const Axis& y, double bottom, bool front, const std::string& caption) {
    std::map<std::string, std::array<std::string, 2>> families;
    for (const Row& row : study.rows)
        if (x.value(row) > 0)
            families[row.about.family][row.misses() > 0 ? 1 : 0] +=
                fmt::format("{} {}\n", x.value(row), y.value(row));
    std::string data, series;
    std::size_t index = 0, family = 0;
    for (const auto& [named, kinds] : families) {
        bool titled = false;
        for (const std::size_t missing : {std::size_t{0}, std::size_t{1}}) {
            if (kinds[missing].empty()) continue;
            data += kinds[missing] + "\n\n";
            series +=
                fmt::format("{}FILE index {} using 1:2 with points pt {} ps 1.0 lw 1.5 lc rgb \"{}\" {}",
                            index ? ", " : "", index, missing ? 6 : 7, colour(family),
                            titled ? "notitle" : fmt::format("title {}", inQuotes(named)));
            titled = true;
            ++index;
        }
        ++family;
    }
    if (front) {
        const std::vector<const Row*> best = paretoFront(study.rows, x.value, y.value);
        for (const Row* row : best) data += fmt::format("{} {}\n", x.value(*row), y.value(*row));
        if (!best.empty()) {
            data += fmt::format("{} {}\n", 3 * x.value(*best.back()), y.value(*best.back()));
            series += fmt::format(
                ", FILE index {} using 1:2 with steps lw 1.5 dt 2 lc rgb \"#444444\" title \"Pareto front\"",
                index);
        }
    }
    series += ", NaN with points pt 6 lw 1.5 lc rgb \"#444444\" title \"hollow: misses contacts\"";
    drawing.draw(
        name, data,
        powersOfTen("xy") +
            fmt::format("set xlabel {}\nset ylabel {}\nset yrange [{}:*]\nset title {} noenhanced\nplot {}\n",
                        inQuotes(x.label), inQuotes(y.label), bottom * 0.5, inQuotes(title), series),
        caption, 1100, 620);
}

void drawSteps(Drawing& drawing, const PairStudy& study) {
    const StepStudy& steps = study.steps;
    std::string data = "# step leading touching inRegion";
    for (const StepSeries& series : steps.series) data += fmt::format(" {}", inQuotes(series.name));
    data += "\n";
    double most = 1;
    for (std::size_t s = 0; s < steps.leading.size(); ++s) {
        data +=
            fmt::format("{} {} {} {}", s, steps.leading[s], int(steps.touching[s]), int(steps.inRegion[s]));
        for (const StepSeries& series : steps.series) {
            data += fmt::format(" {}", series.tests[s]);
            most = std::max(most, series.tests[s]);
        }
        data += "\n";
    }
    // A step without any test has no place on a logarithmic axis: it is drawn at the bottom, as half a test.
    std::string script = fmt::format(
        "{}unset format x\nunset logscale x\nset xlabel \"step of the motion\"\n"
        "set ylabel \"sphere tests a step (bottom: none)\"\nset yrange [0.2:{}]\nset xrange [0:{}]\n"
        "set title {} noenhanced\nplot ",
        powersOfTen("y"), 3 * most, std::max<std::size_t>(1, steps.leading.size() - 1),
        inQuotes(fmt::format("Tests a step along {}", steps.motion)));
    for (std::size_t k = 0; k < steps.series.size(); ++k)
        script += fmt::format(
            "FILE using 1:(${0} > 0.5 ? ${0} : 0.5) with lines lw 2 dt {3} lc rgb \"{1}\" title {2}, ", k + 5,
            colour(k), inQuotes(steps.series[k].name),
            k + 1 < steps.series.size() ? "1" : "(8,8)"); // the last may lie on the one before
    script += "FILE using 1:($4 > 0 ? 0.35 : NaN) with points pt 5 ps 0.5 lc rgb \"#f0a0a0\" title \"in the "
              "angular region\", FILE using 1:($3 > 0 ? 0.25 : NaN) with points pt 5 ps 0.5 lc rgb "
              "\"#dd181f\" title \"meshes touch\"\n";
    drawing.draw("steps", data, script,
                 "Sphere tests a step along the motion (the paper's Figure 2j). Sphere trees and all pairs "
                 "stop at the first hit; the table is counted with all of its tests, of which its kernels "
                 "leave out what cannot matter at the step.",
                 1100, 560);
}

void drawRegion(Drawing& drawing, const PairStudy& study) {
    std::string data;
    const RegionCurve &spheres = study.region.spheres, &meshes = study.region.meshes;
    for (std::size_t k = 0; k < spheres.middle.size(); ++k)
        data += fmt::format("{} {} {}\n", spheres.middle[k], 100 * spheres.share[k], 100 * meshes.share[k]);
    std::string shaded;
    if (meshes.upper > meshes.lower)
        shaded = fmt::format(
            "set obj 1 rect from {},0 to {},105 fc rgb \"#dd181f\" fs solid 0.08 noborder behind\n",
            meshes.lower, meshes.upper);
    drawing.draw(
        "region", data,
        fmt::format(
            "set xlabel {}\nset ylabel \"poses that collide, %\"\nset yrange [0:105]\n"
            "set title \"{}egion of collision\"\n{}plot FILE using 1:2 with lines lw 2 lc rgb "
            "\"#0060ad\" title \"spheres of {}\", FILE using 1:3 with lines lw 2 lc rgb \"#dd181f\" title "
            "\"meshes\", NaN with lines lw 10 lc rgb \"#fbe3e4\" title \"region of the meshes\"\n",
            inQuotes(fmt::format("{}, {}", study.leadingDof, study.leadingUnit)),
            study.leadingUnit == "degrees" ? "Angular r" : "R", shaded, study.base.name),
        "Share of poses that collide by the leading DOF, the other DOFs anywhere in their limits (the "
        "paper's Figure 2i).");
}

void drawSampling(Drawing& drawing, const PairStudy& study) {
    constexpr double none = 1e-3; // per cent, where 0 is drawn
    std::map<std::string, std::string> bySearch;
    for (const SamplingPoint& point : study.sampling)
        bySearch[point.reduce] +=
            fmt::format("{} {} {} {}\n", point.samples, std::max(none, 100 * point.missedUniform),
                        std::max(none, 100 * point.missedNear), point.tests);
    std::string data, series;
    std::size_t index = 0;
    for (const auto& [reduce, points] : bySearch) {
        data += points + "\n\n";
        for (const int column : {2, 3})
            series += fmt::format(
                "{}FILE index {} using 1:{} with linespoints lw 2 pt {} dt {} lc rgb \"{}\" title \"{}, {}\"",
                series.empty() ? "" : ", ", index, column, column == 2 ? 7 : 6, column == 2 ? 1 : 2,
                colour(index), reduce == "none" ? "sampled search alone" : "with the paper's reduction",
                column == 2 ? "uniform poses" : "near contact");
        ++index;
    }
    drawing.draw(
        "sampling", data,
        powersOfTen("xy") +
            fmt::format("set xlabel \"poses explored when baking\"\nset ylabel \"colliding poses missed, % "
                        "(bottom: none)\"\nset yrange [{}:200]\nset title \"What a sampled search misses\"\n"
                        "plot {}\n",
                        0.7 * none, series),
        "Poses at which the whole sphere model collides and a table from a sampled search does not, at poses "
        "that the search has not seen. A certified table is at 0, proven.",
        1000, 540);
}

void drawEpsilon(Drawing& drawing, const PairStudy& study) {
    double least = INFINITY, most = 0;
    for (const BakePoint& point : study.epsilons) {
        if (point.epsilon > 0) least = std::min(least, point.epsilon * study.millimetres);
        most = std::max(most, static_cast<double>(point.tests));
    }
    if (!std::isfinite(least)) return;
    std::string data;
    for (const BakePoint& point : study.epsilons)
        data += fmt::format("{} {} {}\n", point.epsilon > 0 ? point.epsilon * study.millimetres : least / 4,
                            point.tests, point.lowerBound ? fmt::format("{}", *point.lowerBound) : "NaN");
    drawing.draw(
        "epsilon", data,
        fmt::format("set logscale x\nset xlabel \"ε, mm (leftmost: 0, lossless)\"\n"
                    "set ylabel \"tests a step\"\nset yrange [0:{}]\nset title \"Table size against ε\"\n"
                    "plot FILE using 1:2 with linespoints lw 2 pt 7 lc rgb \"#0060ad\" title \"tests\", FILE "
                    "using 1:3 with linespoints lw 2 dt 2 pt 6 lc rgb \"#5b5b5b\" title \"lower bound\"\n",
                    1.15 * most),
        "Tests a step against ε, with the bound below which no table of the same answers can be.");
}

void drawBake(Drawing& drawing, const PairStudy& study) {
    std::string data;
    for (const BakePoint& point : study.tolerances)
        data += fmt::format("{} {} {} {} {}\n", point.spheresA + point.spheresB, point.sphereSeconds,
                            point.tableSeconds, point.tests, point.tolerance * study.millimetres);
    drawing.draw(
        "bake", data,
        "set logscale xy\nset logscale y2\nset xlabel \"spheres of both bodies\"\nset ylabel \"seconds\"\n"
        "set y2label \"tests a step\"\nset ytics nomirror\nset y2tics\nset y2range [0.5:*]\n"
        "set key outside top center horizontal\n"
        "set title \"Bake time and table size against the number of spheres\" offset 0,1\nset tmargin 5\n"
        "plot FILE using 1:2 with linespoints lw 2 pt 7 lc rgb \"#0060ad\" title \"spheres, s\", FILE using "
        "1:3 with linespoints lw 2 pt 7 lc rgb \"#dd181f\" title \"table, s\", FILE using 1:4 axes x1y2 with "
        "linespoints lw 2 dt 2 pt 6 lc rgb \"#2a8c2a\" title \"tests (right)\"\n",
        "Seconds to make spheres and table, and the table's tests, as the tolerance falls.");
}

} // namespace

std::vector<Plot> drawPlots(const PairStudy& study, const std::string& folder, const std::string& stem,
                            std::string& problem) {
    Drawing drawing(folder, stem);
    const std::string against = fmt::format("{} against {}", study.nameB, study.nameA);
    const double mm = study.millimetres;
    const Axis time{"time a query, ns (median)", [](const Row& row) { return row.times.median; }};
    const Axis memory{"bytes that a query reads from",
                      [](const Row& row) { return double(row.about.bytes); }};
    const Axis worst{"worst error, mm", [mm](const Row& row) { return errorOf(row, mm); }};
    const Axis wrong{"wrong verdicts at uniform poses, %",
                     [](const Row& row) { return std::max(leastWrongDrawn, 100 * row.wrong()); }};
    drawErrors(
        drawing, study, "pareto", fmt::format("Error against run time: {}", against), time, worst,
        leastErrorDrawn, true,
        fmt::format(
            "Worst error against the meshes (deepest contact missed or farthest early contact, at uniform "
            "and near-contact poses) against the time of a query, every method with every setting. Methods "
            "with no error, or less, stand at {} mm. Nothing beats in both what lies on the Pareto front.",
            leastErrorDrawn));
    drawErrors(drawing, study, "verdicts", fmt::format("Wrong verdicts against run time: {}", against), time,
               wrong, leastWrongDrawn, true,
               fmt::format("How often a method is wrong, against its time: contacts missed and early ones "
                           "together, of all uniform poses. None stands at {} %.",
                           leastWrongDrawn));
    drawErrors(drawing, study, "memory", fmt::format("Error against memory: {}", against), memory, worst,
               leastErrorDrawn, true, "The worst errors against what each method keeps in memory.");
    drawSteps(drawing, study);
    drawRegion(drawing, study);
    drawSampling(drawing, study);
    drawEpsilon(drawing, study);
    drawBake(drawing, study);
    if (!drawing.problem.empty()) problem = drawing.problem;
    return drawing.plots;
}

} // namespace tss::reporting
