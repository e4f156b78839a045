#include "bake/report/Text.h"

#include "bake/report/Columns.h"

#include <fmt/format.h>

namespace tss::reporting {

namespace {

/// What a table is made of; besidePaper: with the paper's own skin beside it.
std::string countTable(const SkinStudy& study, bool besidePaper) {
    const auto paper = [&](const char* text) { return std::string(besidePaper ? text : ""); };
    std::string text = fmt::format(
        "| |{} skin at rest (the paper's way) | skin carried by its muscles (what `tss bake` makes) |\n"
        "|---|{}---|---|\n| spheres |{} {} + {} | {} + {} |\n| spheres used |{} {} + {} | {} + {} |\n"
        "| tests a step |{} {} | {} |\n| products a step |{} {} | {} |\n",
        paper(" the paper: skin + muscle |"), paper("---|"), paper(" 1426 + 280 |"), study.skinSpheres,
        study.muscleSpheres, study.skinSpheres, study.muscleSpheres, paper(" 70 + 190 |"), study.usedSkin,
        study.usedMuscle, study.carriedSkin, study.carriedMuscle, paper(" 268 |"), study.tests,
        study.carriedTests, paper(" 1072 |"), 4 * study.tests, 4 * study.carriedTests);
    const auto withEllipsoids = [&](std::size_t spheres) {
        return study.productsEllipsoid * static_cast<double>(spheres * study.muscles);
    };
    return text + fmt::format("| products a step, the same skin spheres against one bent ellipsoid a muscle "
                              "|{} {:.0f} ({} × {:.0f}) | {:.0f} |\n",
                              paper(" 2870 (70 × 41) |"), withEllipsoids(study.usedSkin),
                              study.usedSkin * study.muscles, study.productsEllipsoid,
                              withEllipsoids(study.carriedSkin));
}

std::string answerTable(const SkinStudy& study) {
    return markdownTable(answerColumns(study), study.motion.answers,
                         [](const SkinAnswer& a) { return a.usual; });
}

} // namespace

std::string skinText(const SkinStudy& study, const std::vector<Plot>& plots, bool besidePaper) {
    const double mm = study.millimetres;
    const SkinMotionStudy& motion = study.motion;
    std::string text = fmt::format(
        "## {}\n\nA skin of {} vertices over {} muscle{}.\n\n### {}\n\n", study.path, study.skinSpheres,
        study.muscles, study.muscles == 1 ? "" : "s", besidePaper ? "Beside the paper" : "The table");
    text += countTable(study, besidePaper);
    if (besidePaper) text += "\nThe meshes are not the same: the counts say of what size such tables are.\n";
    text += fmt::format("\n### Which skin spheres touch a muscle\n\n"
                        "The paper's question, at {} activations: which of the skin's spheres, one a vertex "
                        "at its rest place with a radius of {} mm, touch a muscle? The truth is the distance "
                        "of the vertex to the muscle's surface: within the radius at {} of {} vertices and "
                        "activations. The spheres stand in for the surface and stick out of it, so that "
                        "sphere methods say so somewhat early; all over the same spheres agree.\n\n",
                        study.activations, number(study.thickness * mm), study.touching, study.judged);
    text += pictureText(plots, "pareto") + markdownTable(methodColumns(study), study.methods) + "\n" +
            pictureText(plots, "steps");
    for (const SkinMethod& m : study.methods) text += fmt::format("- **{}**: {}.\n", m.name, m.about);
    if (motion.answers.empty())
        return text + "\nNothing of the skin moves.\n\n### What was not run\n\n" + notRunText(study.notRun) +
               "\n";
    text += fmt::format("\n### What the skin does about it\n\nPlayed over {} steps along {}; {} of the "
                        "vertices can move, at most {} mm. The muscles keep their volume to {:.1e} of it. ",
                        motion.steps, motion.motion, motion.touched, number(motion.farthestMove * mm),
                        motion.muscleVolume);
    text += motion.untouched > 0
                ? fmt::format("Deepest left: how much deeper than at rest a skin vertex is in a muscle; it "
                              "would be {} mm if the skin stayed where it is, and is {} mm in the converged "
                              "solve, the same problem solved until nothing moves.\n\n",
                              number(motion.untouched * mm), number(motion.converged * mm))
                : "In this motion no muscle comes deeper into the skin than it is at rest, even if the skin "
                  "stayed where it is: there is no overlap to resolve, the muscles only carry the skin "
                  "along.\n\n";
    if (motion.untouched > 0) text += pictureText(plots, "answer");
    text += answerTable(study) + "\n" + pictureText(plots, "depth");
    return text + "### What was not run\n\n" + notRunText(study.notRun) + "\n";
}

} // namespace tss::reporting
