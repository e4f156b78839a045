#include "bake/report/Report.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace tss::reporting {

namespace {

/// Three digits, thousands as they are.
std::string number(double value) {
    if (value == 0) return "0";
    if (value >= 1000) return fmt::format("{:.0f}", value);
    return fmt::format("{:.3g}", value);
}

std::string timeText(const Times& times) {
    const auto one = [](double ns) {
        return ns < 1000  ? number(ns) + " ns"
               : ns < 1e6 ? number(ns / 1e3) + " µs"
                          : number(ns / 1e6) + " ms";
    };
    if (!(times.median > 0)) return "";
    return fmt::format("{} ({}–{})", one(times.median), one(times.low), one(times.high));
}

std::string bytesText(std::size_t bytes) {
    if (bytes < 10000) return fmt::format("{} B", bytes);
    if (bytes < 10000000) return fmt::format("{} kB", bytes / 1000);
    return fmt::format("{} MB", bytes / 1000000);
}

std::string share(std::size_t part, std::size_t whole) {
    return whole == 0 ? "–" : fmt::format("{} of {}", part, whole);
}

std::string stated(double length, double mm) {
    return length < 0 ? "–" : number(length * mm);
}

std::string orDash(double value) {
    return value < 0 ? "–" : number(value);
}

const Row* findRow(const PairStudy& study, const std::string& method, const std::string& setting) {
    for (const Row& row : study.rows)
        if (row.method == method && (setting.empty() || row.setting == setting)) return &row;
    return nullptr;
}

/// The setting that every method was built for.
const BakePoint& basePoint(const PairStudy& study, bool quick) {
    return study.bakes[quick || study.bakes.size() < 2 ? study.bakes.size() - 1 : study.bakes.size() - 2];
}

std::string methodTable(const PairStudy& study) {
    const double mm = study.millimetres;
    std::string text =
        "| method | spheres' tolerance | missed, uniform | missed, near contact | deepest missed, mm | "
        "early, uniform | farthest early, mm | stated: miss / early, mm | first contact off by, mm | "
        "time a query (p10–p90) | tests | products | bytes | built in, s |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    std::vector<const Row*> rows;
    for (const Row& row : study.rows) rows.push_back(&row);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Row* a, const Row* b) { return a->about.family < b->about.family; });
    for (const Row* row : rows)
        text +=
            fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} / {} | {}{} | {} | {} | {} | {} | {} |\n",
                        row->method, row->setting, share(row->uniform.missed, row->uniform.touching),
                        share(row->near.missed, row->near.touching),
                        number(mm * std::max(row->uniform.deepestMiss, row->near.deepestMiss)),
                        share(row->uniform.early, row->uniform.poses - row->uniform.touching),
                        number(mm * std::max(row->uniform.farthestEarly, row->near.farthestEarly)),
                        stated(row->about.stated.miss, mm), stated(row->about.stated.early, mm),
                        number(mm * row->firstContact.worstLength),
                        row->firstContact.never ? fmt::format(" ({} never)", row->firstContact.never) : "",
                        timeText(row->times), orDash(row->tests), orDash(row->products),
                        bytesText(row->about.bytes), number(row->about.buildSeconds));
    return text;
}

std::string whatTheyAre(const PairStudy& study) {
    std::string text;
    std::vector<std::string> said;
    for (const Row& row : study.rows) {
        if (std::find(said.begin(), said.end(), row.method) != said.end()) continue;
        said.push_back(row.method);
        text += fmt::format("- **{}**: {}.\n", row.method, row.about.about);
    }
    return text;
}

/// When to choose what, from the figures above and nothing else.
std::string advice(const PairStudy& study, bool quick) {
    const BakePoint& base = basePoint(study, quick);
    const std::string setting = fmt::format("{:.3g} mm", base.tolerance * study.millimetres);
    const Row* ours = findRow(study, "tss", setting);
    if (!ours || !(ours->times.median > 0)) return "";
    std::string text;
    const auto ratio = [&](const Row& row) {
        const double r = row.times.median / ours->times.median;
        return r >= 1 ? fmt::format("{} times the table's time", number(r))
                      : fmt::format("{} of the table's time", number(r));
    };
    for (const Row& row : study.rows) {
        if (row.about.family != "C-space grid") continue;
        const bool faster = row.times.median < ours->times.median,
                   smaller = row.about.bytes < ours->about.bytes;
        text += fmt::format(
            "- {}: {}, {} against {}; {} contacts missed, farthest early {} mm (the table: {} and {} mm). "
            "{}\n",
            row.method, ratio(row), bytesText(row.about.bytes), bytesText(ours->about.bytes), row.misses(),
            number(study.millimetres * std::max(row.uniform.farthestEarly, row.near.farthestEarly)),
            ours->misses(),
            number(study.millimetres * std::max(ours->uniform.farthestEarly, ours->near.farthestEarly)),
            faster && row.misses() == 0 && row.worst() <= ours->worst() * 1.1
                ? "**Here the grid wins**: take it where only yes or no is wanted, memory is no matter, and "
                  "no bound "
                  "is needed."
            : faster  ? "Quicker, but not as right."
            : smaller ? "Smaller, not quicker."
                      : "");
    }
    for (const char* name :
         {"fcl-obbrss", "bullet-gimpact", "tree-all-8-balls", "tree-used-8-balls", "tss-scalar"}) {
        const Row* row = findRow(study, name, std::string(name).rfind("t", 0) == 0 ? setting : "");
        if (row) text += fmt::format("- {}: {}.\n", name, ratio(*row));
    }
    text +=
        "\nChoose the **table** where the motion is constrained and known when baking, each frame asks, and "
        "it "
        "must be known how wrong an answer can be; it also gives gap, contact point, normal and gradient. "
        "Choose a "
        "**grid of gaps** for yes or no over one or two DOFs where memory is cheap: its time hardly grows "
        "with the "
        "shape, but its memory grows with the power of the DOFs and it knows no contact point. Choose a "
        "**mesh "
        "tree** (FCL, Bullet) where the motion is free or the exact answer of the triangles is wanted and a "
        "hundred microseconds do not matter. A **sphere tree** serves where spheres are wanted and the "
        "motion is "
        "not known beforehand.\n";
    return text;
}

std::string paperTable(const PairStudy& study, bool quick) {
    const BakePoint &ours = basePoint(study, quick), &paper = study.paper;
    std::size_t inside = 0;
    for (const char c : study.steps.inRegion) inside += c != 0 ? 1 : 0;
    const double steps = static_cast<double>(std::max<std::size_t>(1, study.steps.inRegion.size()));
    return fmt::format(
        "| | the paper: dog's skull + mandible | its recipe on this pair (growth, sampled, co-occurrence) | "
        "this "
        "software's default ({:.3g} mm, lossless, certified) |\n|---|---|---|---|\n"
        "| spheres | 1158 + 812 | {} + {} | {} + {} |\n| spheres used | 9 + 22 | {} + {} | {} + {} |\n"
        "| tests a step | 22 | {} | {} (no lossless table has fewer than {}) |\n"
        "| products a step | 88 | {} | {} |\n"
        "| steps in the collision region | 22 % | | {:.0f} % of {} ({}) |\n\n"
        "Different meshes and limits: the counts say of what size such tables are, not which method is "
        "better.\n",
        ours.tolerance * study.millimetres, paper.spheresA, paper.spheresB, ours.spheresA, ours.spheresB,
        paper.usedA, paper.usedB, ours.usedA, ours.usedB, paper.tests, ours.tests, number(ours.lowerBound),
        4 * paper.tests, 4 * ours.tests, 100 * static_cast<double>(inside) / steps,
        study.steps.inRegion.size(), study.steps.motion);
}

std::string sweeps(const PairStudy& study) {
    const double mm = study.millimetres;
    std::string text =
        "| tolerance, mm | spheres | used | tests | lower bound | bytes | spheres, s | table, s |\n"
        "|---|---|---|---|---|---|---|---|\n";
    for (const BakePoint& p : study.bakes)
        text += fmt::format("| {} | {} + {} | {} + {} | {} | {} | {} | {} | {} |\n", number(p.tolerance * mm),
                            p.spheresA, p.spheresB, p.usedA, p.usedB, p.tests, number(p.lowerBound),
                            bytesText(p.bytes), number(p.sphereSeconds), number(p.tableSeconds));
    text += "\n| ε, mm | tests | lower bound | s |\n|---|---|---|---|\n";
    for (const EpsilonPoint& p : study.epsilons)
        text += fmt::format("| {} | {} | {} | {} |\n", number(p.epsilon * mm), p.tests, number(p.lowerBound),
                            number(p.seconds));
    text += "\nWhat a sampled search misses of what the same spheres collide at:\n\n"
            "| poses explored | reduction | tests | missed, uniform | missed, near contact | s "
            "|\n|---|---|---|---|---|---|\n";
    for (const SamplingPoint& p : study.sampling)
        text += fmt::format("| {} | {} | {} | {:.3g} % | {:.3g} % | {} |\n", p.samples,
                            p.reduce == "none" ? "none" : "co-occurrence (the paper's)", p.tests,
                            100 * p.missedUniform, 100 * p.missedNear, number(p.seconds));
    return text;
}

std::string notRunText(const std::vector<NotRun>& notRun) {
    std::string text;
    for (const NotRun& entry : notRun) text += fmt::format("- {}: {}.\n", entry.method, entry.reason);
    return text;
}

std::string pairText(const PairStudy& study, const std::vector<Plot>& plots, bool quick) {
    std::string text = fmt::format("## {}: {} against {}\n\n{} + {} triangles", study.path, study.nameB,
                                   study.nameA, study.trianglesA, study.trianglesB);
    for (const std::string& dof : study.dofs) text += "; " + dof;
    text += ".\n\n";
    if (study.neverCollides)
        return text +
               fmt::format(
                   "The two can never meet within these limits: their sphere models stay {} mm apart at "
                   "every pose, proven. No table is needed and no method has anything to find.\n\n",
                   number(study.clearance * study.millimetres));
    text += fmt::format("{} poses uniformly over the limits, {} of them touching by the meshes; {} poses "
                        "near contact, both ends of "
                        "segments bisected to 1e-6 of the limits; {} of the uniform poses timed. Contact at "
                        "rest counts as contact, "
                        "as the meshes say.\n\n### Beside the paper\n\n{}\n### Error against run time\n\n",
                        study.uniformPoses, study.touchingUniform, study.nearPoses, study.timedPoses,
                        paperTable(study, quick));
    const auto picture = [&](const char* part) {
        for (const Plot& plot : plots)
            if (plot.file.find(part) != std::string::npos)
                text += fmt::format("![{}]({})\n\n{}\n\n", part, plot.file, plot.caption);
    };
    picture("pareto");
    text +=
        methodTable(study) +
        "\nMissed: of the poses where the meshes touch, those where the method says free (depth: that of the "
        "deepest vertex of one mesh inside the other, 0 where only edges cross). Early: of the free poses, "
        "those "
        "where it says contact (by the clearance of the meshes). Stated: what the method promises for every "
        "pose; "
        "– where it promises nothing. First contact: how far the farthest point of the moving body is from "
        "where "
        "it truly first touches, at worst, along straight ways from a free to a touching pose.\n\n"
        "### When to choose what\n\n" +
        advice(study, quick) + "\n### Along a motion\n\n";
    picture("steps");
    picture("region");
    text += fmt::format("The angular region of collision is {:.3g} to {:.3g} {} of {}.\n\n### Sweeps\n\n",
                        study.region.lower, study.region.upper, study.leadingUnit, study.leadingDof);
    text += sweeps(study) + "\n";
    for (const char* part : {"sampling", "epsilon", "bake", "memory"}) picture(part);
    text += "### What each method is\n\n" + whatTheyAre(study) + "\n### What was not run\n\n" +
            notRunText(study.notRun);
    return text + "\n";
}

std::string skinText(const SkinStudy& study) {
    const double mm = study.millimetres;
    std::string text = fmt::format(
        "## {}: skin over {} muscle{}\n\n"
        "| | the paper: skin + muscle | this scene, skin at rest (the paper's way) | this scene, skin "
        "carried (default) |\n"
        "|---|---|---|---|\n| spheres | 1426 + 280 | {} + {} | {} + {} |\n| spheres used | 70 + 190 | {} + "
        "{} | {} + {} |\n"
        "| tests a step | 268 | {} | {} |\n| products a step | 1072 | {} | {} |\n"
        "| products a step with ellipsoids | 2870 (41 a test) | {:.0f} ({:.0f} a test) | |\n\n",
        study.path, study.muscles, study.muscles == 1 ? "" : "s", study.skinSpheres, study.muscleSpheres,
        study.skinSpheres, study.muscleSpheres, study.usedSkin, study.usedMuscle, study.carriedSkin,
        study.carriedMuscle, study.tests, study.carriedTests, 4 * study.tests, 4 * study.carriedTests,
        study.productsEllipsoid * static_cast<double>(study.usedSkin * study.muscles),
        study.productsEllipsoid);
    text += fmt::format(
        "{} activations, {} skin spheres of radius {} mm each; at {} of {} vertex and activation pairs the "
        "muscle's surface is within that radius of the vertex at rest.\n\n"
        "| method | tests a step | products a step | time a step | missed | deepest, mm | early | farthest, "
        "mm |\n"
        "|---|---|---|---|---|---|---|---|\n",
        study.activations, study.skinSpheres, number(study.thickness * mm), study.touching, study.judged);
    for (const SkinMethod& m : study.methods)
        text += fmt::format("| {} | {} | {} | {} µs | {} | {} | {} | {} |\n", m.name, number(m.tests),
                            number(m.products), number(m.nanoseconds / 1e3), m.missed,
                            number(m.deepestMiss * mm), m.early, number(m.farthestEarly * mm));
    text += "\nWhat each method is:\n\n";
    for (const SkinMethod& m : study.methods) text += fmt::format("- **{}**: {}.\n", m.name, m.about);
    return text + "\nWhat was not run:\n\n" + notRunText(study.notRun) + "\n";
}

} // namespace

std::string markdownOf(const Report& report) {
    const Machine& machine = report.machine;
    std::string text =
        fmt::format("# Error against run time: {}\n\n"
                    "Made by `tss report{}`, seed {}, in {:.0f} s on {} ({} cores), {}, {}, kernels in {}; "
                    "{}. One process, one thread "
                    "when timing, the methods in turns, after a warm-up; medians, with the tenth and "
                    "ninetieth percentile. Every "
                    "query is given its DOF values and its pose; each method starts from what it needs.\n\n",
                    report.scene, report.options.quick ? " --quick" : "", report.options.seed, report.seconds,
                    machine.processor, machine.cores, machine.compiler, machine.build, machine.vectors,
                    machine.libraries);
    if (!report.plotProblem.empty()) text += report.plotProblem + "\n\n";
    for (std::size_t k = 0; k < report.pairs.size(); ++k)
        text += pairText(report.pairs[k], report.plots[k], report.options.quick);
    for (const SkinStudy& study : report.skins) text += skinText(study);
    return text + "## Licence\n\nThe minimal enclosing balls and the Delaunay balls of this report come from "
                  "CGAL, which "
                  "is GPL-3.0-or-later: a `tss` built with `OSGTSS_REPORT` may be passed on under that "
                  "licence only. "
                  "Nothing else of osgTSS links it.\n";
}

} // namespace tss::reporting
