#include "bake/report/Drawing.h"

#include <algorithm>
#include <fmt/format.h>

namespace tss::reporting {

namespace {

constexpr double drawnAsNone = 1e-3; ///< where an error of 0 is drawn, mm

void drawMethods(Drawing& drawing, const SkinStudy& study) {
    std::string data, series;
    for (std::size_t k = 0; k < study.methods.size(); ++k) {
        const SkinMethod& m = study.methods[k];
        data +=
            fmt::format("{} {}\n\n\n", m.nanoseconds / 1000,
                        std::max(drawnAsNone, study.millimetres * std::max(m.deepestMiss, m.farthestEarly)));
        series +=
            fmt::format("{}FILE index {} using 1:2 with points pt {} ps 1.4 lw 2 lc rgb \"{}\" title {}",
                        k ? ", " : "", k, m.missed ? 6 : 7, colour(k), inQuotes(m.name));
    }
    drawing.draw(
        "pareto", data,
        fmt::format("set logscale xy\nset xlabel \"time a step, µs (median)\"\nset ylabel \"worst error, mm "
                    "(bottom: none)\"\nset format y \"%g\"\nset title \"Which skin spheres touch: error "
                    "against run time\"\nset offsets graph 0.1, graph 0.1, graph 0.3, graph 0.3\nplot {}, "
                    "NaN with points pt 6 lw 2 lc rgb \"#444444\" title \"hollow: misses contacts\"\n",
                    series),
        fmt::format("Worst error against the {}s' surfaces (deepest contact missed or farthest early "
                    "contact) against the time of a step.",
                    study.muscles > 0 && study.bones > 0 ? "part" : study.partName()),
        900, 480);
}

void drawSteps(Drawing& drawing, const SkinStudy& study) {
    std::string data, series;
    for (std::size_t s = 0; s < study.activation.size(); ++s) {
        data += fmt::format("{}", study.activation[s]);
        for (const SkinMethod& m : study.methods) data += fmt::format(" {}", m.perStep[s]);
        data += "\n";
    }
    for (std::size_t k = 0; k < study.methods.size(); ++k)
        series += fmt::format("{}FILE using 1:{} with linespoints pt {} ps 0.6 lw 2 lc rgb \"{}\" title {}",
                              k ? ", " : "", k + 2, k + 4, colour(k), inQuotes(study.methods[k].name));
    drawing.draw("steps", data,
                 fmt::format("set logscale y\nset format y \"10^{{%L}}\"\nset termoption enhanced\nset "
                             "xlabel \"activation\"\nset ylabel \"tests a step\"\nset title \"Tests a step "
                             "as the muscles contract\"\nplot {}\n",
                             series),
                 "Tests a step over the activation (the paper's Figure 2j): of two spheres, or of a sphere "
                 "and an ellipsoid, which takes some ten times the products.");
}

std::string whereNothingPushes(const SkinStudy& study) {
    return study.motion.bones ? "if the skin were only carried" : "if the skin stayed at rest";
}

void drawAnswers(Drawing& drawing, const SkinStudy& study) {
    std::string data[2], labels;
    for (const SkinAnswer& a : study.motion.answers) {
        data[a.sweeps > 0 ? 0 : 1] += fmt::format("{} {} {}\n", a.nanoseconds / 1000,
                                                  std::max(drawnAsNone, study.millimetres * a.deepest),
                                                  std::max(drawnAsNone, study.millimetres * a.farthest));
        if (a.sweeps > 0)
            labels += fmt::format("set label \"{}\" at {},{} offset 0,-0.9 center font \",11\"\n", a.sweeps,
                                  a.nanoseconds / 1000, std::max(drawnAsNone, study.millimetres * a.deepest));
    }
    drawing.draw(
        "answer", data[0] + "\n\n" + data[1],
        fmt::format("set logscale xy\nset xlabel \"time an update, µs (median)\"\nset ylabel \"mm\"\n"
                    "set title \"What is left of overlap against the time of an update (numbers: sweeps)\"\n"
                    "set offsets graph 0.1, graph 0.1, graph 0.15, graph 0.15\n{}plot FILE index 0 using 1:2 "
                    "with linespoints lw 2 pt 7 lc rgb \"{}\" title \"deepest left\", FILE index 0 using 1:3 "
                    "with linespoints lw 2 dt 2 pt 6 lc rgb \"{}\" title \"farthest from converged\", FILE "
                    "index 1 using 1:2 with points pt 5 ps 1.3 lc rgb \"{}\" title \"deepest left, the "
                    "paper's way\", {} with lines dt 3 lw 2 lc rgb \"#444444\" title {}\n",
                    labels, colour(0), colour(1), colour(2),
                    std::max(drawnAsNone, study.millimetres * study.motion.untouched),
                    inQuotes(whereNothingPushes(study))),
        "Residual depth of the skin in what is below it, and distance to the converged solve, against the "
        "time of an update, for several numbers of sweeps.",
        1000, 520);
}

void drawDepth(Drawing& drawing, const SkinStudy& study) {
    const SkinMotionStudy& motion = study.motion;
    std::string data;
    for (std::size_t s = 0; s < motion.perStepUsual.size(); ++s)
        data += fmt::format("{} {} {} {}\n", s, motion.perStepAsked[s],
                            study.millimetres * motion.perStepUntouched[s],
                            study.millimetres * motion.perStepUsual[s]);
    const bool contracts = study.activations > 1;
    std::string script = "set xlabel \"step of the motion\"\nset ylabel \"deepest skin vertex, mm\"\nset "
                         "yrange [0:*]\nset autoscale xfix\nset key outside top center horizontal\nset "
                         "tmargin 5\nset title \"Overlap along the motion\" offset 0,1\n";
    if (contracts)
        script += "set y2label \"activation\"\nset ytics nomirror\nset y2tics\nset y2range [0:*]\n";
    script += fmt::format("plot FILE using 1:3 with lines lw 2 lc rgb \"#dd181f\" title {}, FILE using 1:4 "
                          "with lines lw 2 lc rgb \"#0060ad\" title \"left by the response\"{}\n",
                          inQuotes(whereNothingPushes(study)),
                          contracts ? ", FILE using 1:2 axes x1y2 with lines lw 1.5 dt 2 lc rgb \"#5b5b5b\" "
                                      "title \"activation (right)\""
                                    : "");
    drawing.draw("depth", data, script,
                 fmt::format("How much deeper than at rest the deepest skin vertex is in a {}, step by step.",
                             study.partName()));
}

} // namespace

std::vector<Plot> drawPlots(const SkinStudy& study, const std::string& folder, const std::string& stem,
                            std::string& problem) {
    Drawing drawing(folder, stem);
    drawMethods(drawing, study);
    if (study.activations > 1) drawSteps(drawing, study);
    if (study.motion.untouched > 0) {
        drawAnswers(drawing, study);
        drawDepth(drawing, study);
    }
    if (!drawing.problem.empty()) problem = drawing.problem;
    return drawing.plots;
}

} // namespace tss::reporting
