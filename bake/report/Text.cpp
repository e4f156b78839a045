#include "bake/report/Text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace tss::reporting {

namespace {

/// The options as the command line takes them.
std::string optionsText(const ReportOptions& options) {
    std::string text = options.quick ? " --quick" : "";
    for (const std::string& pair : options.pairs) text += " --pair " + pair;
    if (!options.methods.empty()) text += fmt::format(" --methods {}", fmt::join(options.methods, ","));
    if (!options.motionFile.empty()) text += " --motion " + options.motionFile;
    return text;
}

} // namespace

std::string number(double value) {
    if (value == 0) return "0";
    if (std::abs(value) >= 1000) return fmt::format("{:.0f}", value);
    if (std::abs(value) < 1e-3) return fmt::format("{:.1e}", value);
    return fmt::format("{:.3g}", value);
}

std::string timeText(double ns) {
    return ns < 1000 ? number(ns) + " ns" : ns < 1e6 ? number(ns / 1e3) + " µs" : number(ns / 1e6) + " ms";
}

std::string timeText(const Times& times) {
    if (!(times.median > 0)) return "–";
    const double scale = times.median < 1000 ? 1 : times.median < 1e6 ? 1e3 : 1e6;
    return fmt::format("{} ({}–{})", timeText(times.median), number(times.low / scale),
                       number(times.high / scale));
}

std::string bytesText(std::size_t bytes) {
    if (bytes < 10000) return fmt::format("{} B", bytes);
    if (bytes < 10000000) return fmt::format("{} kB", bytes / 1000);
    return fmt::format("{} MB", bytes / 1000000);
}

std::string shareText(std::size_t part, std::size_t whole) {
    return whole == 0 ? "–" : part == 0 ? "0" : fmt::format("{} of {}", part, whole);
}

std::string notRunText(const std::vector<NotRun>& notRun) {
    std::string text;
    for (const NotRun& entry : notRun) text += fmt::format("- {}: {}.\n", entry.method, entry.reason);
    return text;
}

std::string pictureText(const std::vector<Plot>& plots, const std::string& part) {
    for (const Plot& plot : plots)
        if (plot.file.ends_with("/" + part + ".svg") || plot.file.ends_with("-" + part + ".svg"))
            return fmt::format("![{}]({})\n\n{}\n\n", part, plot.file, plot.caption);
    return "";
}

std::string markdownOf(const Report& report) {
    const compare::Machine& machine = report.machine;
    std::string text = fmt::format(
        "# Error against run time: {}\n\n"
        "Made by `tss report {}{}`, seed {}, in {:.0f} s on {} ({} cores), {}, {}, kernels in {}; {}.\n\n",
        report.scene, report.scene, optionsText(report.options), report.options.seed, report.seconds,
        machine.processor, machine.cores, machine.compiler, machine.build, machine.vectors,
        machine.libraries);
    text += report.pairs.empty()
                ? "Times are medians on one thread, and this machine's. Error figures are the same in every "
                  "run.\n\n"
                : "All methods answer the same question about the same poses in one process: does the moving "
                  "body touch the other? They take turns on one thread after a warm-up; times are medians "
                  "over the rounds, with the tenth and ninetieth percentile. Each query is given its DOF "
                  "values and its pose, made beforehand, and a method starts from whichever of them it "
                  "needs. The truth is the meshes' own (FCL, exact triangle tests). Error figures are the "
                  "same in every run with this seed; times are this machine's.\n\n";
    if (!report.plotProblem.empty()) text += report.plotProblem + "\n\n";
    for (std::size_t k = 0; k < report.pairs.size(); ++k)
        text += pairText(report.pairs[k], report.pairPlots[k], report.options.besidePaper);
    for (std::size_t k = 0; k < report.skins.size(); ++k)
        text += skinText(report.skins[k], report.skinPlots[k], report.options.besidePaper);
    return text + "## Licence\n\nThe minimal enclosing balls and the Delaunay balls of this report come from "
                  "CGAL, which is GPL-3.0-or-later: a `tss` built with `OSGTSS_REPORT` may be passed on "
                  "under that licence only. Nothing else of osgTSS links it.\n";
}

} // namespace tss::reporting
